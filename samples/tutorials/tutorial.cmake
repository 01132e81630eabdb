# The command `twinray`, of this build or installed; and what skips a test where there is no device.
if(TWINRAY_BUILD_CLI)
    set(twinray_command $<TARGET_FILE:twinray_cli>)
    set(needs_device ${PROJECT_SOURCE_DIR}/tests/support/needs_device.sh ${twinray_command})
else()
    find_program(TWINRAY_COMMAND twinray HINTS ${TWINRAY_INCLUDE_DIR}/../bin)
    set(twinray_command ${TWINRAY_COMMAND})
    set(needs_device "")
endif()

# twinray_add_tutorial(<name> <file>...): a program that takes the folder for its pictures, and its test.
function(twinray_add_tutorial name)
    add_executable(${name} ${ARGN})
    target_link_libraries(${name} PRIVATE twinray::validation twinray::twinray)
    twinray_add_tutorial_test(${name} $<TARGET_FILE:${name}> pictures)
endfunction()

# twinray_add_tutorial_test(<test> <file> [argument...]): run beside the program, where it may write.
function(twinray_add_tutorial_test test)
    add_test(NAME tutorials.${test} COMMAND ${needs_device} ${ARGN})
    set_tests_properties(
        tutorials.${test}
        PROPERTIES LABELS vulkan SKIP_RETURN_CODE 77 TIMEOUT 120
    )
endfunction()
