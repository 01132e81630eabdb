# The dependencies between options: a clear error if they contradict each other.
function(twinray_option_needs option)
    foreach(needed ${ARGN})
        if(${option} AND NOT ${needed})
            message(FATAL_ERROR "twinray: ${option}=ON needs ${needed}=ON")
        endif()
    endforeach()
endfunction()

twinray_option_needs(TWINRAY_ANALYSIS TWINRAY_SCENE)
twinray_option_needs(TWINRAY_PYTHON TWINRAY_ANALYSIS TWINRAY_VALIDATION)
twinray_option_needs(TWINRAY_BUILD_PATH_TRACER TWINRAY_SCENE TWINRAY_VALIDATION)
twinray_option_needs(TWINRAY_BUILD_SAMPLES TWINRAY_SCENE TWINRAY_ANALYSIS TWINRAY_VALIDATION)
twinray_option_needs(TWINRAY_BUILD_CLI TWINRAY_SCENE TWINRAY_ANALYSIS TWINRAY_VALIDATION)
twinray_option_needs(
    TWINRAY_BUILD_TESTS
    TWINRAY_BUILD_PATH_TRACER
    TWINRAY_BUILD_CLI
    TWINRAY_BUILD_REPORT
    TWINRAY_BUILD_BENCH
    TWINRAY_BUILD_SAMPLES
)
