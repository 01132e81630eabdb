# twinray_add_shaders(<target> <file>...): compiles each GLSL file under shaders/ to SPIR-V at build time and gives
# <target> a header per file, "<folder>_<stem>.spv.h" with `const uint32_t <folder>_<stem>_spirv[]` (ray tracing
# stages keep their suffix: <folder>_<stem>_rgen). With tests on, each module gets a spirv-val ctest.
set(TWINRAY_SPIRV_DIR ${PROJECT_BINARY_DIR}/spirv)
file(MAKE_DIRECTORY ${TWINRAY_SPIRV_DIR})

function(twinray_add_shaders target)
    foreach(source ${ARGN})
        get_filename_component(folder ${source} DIRECTORY)
        get_filename_component(stem ${source} NAME_WE)
        get_filename_component(extension ${source} LAST_EXT)
        set(name ${folder}_${stem})
        if(NOT extension STREQUAL ".comp")
            string(REPLACE "." "_" suffix ${extension})
            string(APPEND name ${suffix})
        endif()
        set(input ${PROJECT_SOURCE_DIR}/shaders/${source})
        set(header ${TWINRAY_SPIRV_DIR}/${name}.spv.h)
        set(module ${TWINRAY_SPIRV_DIR}/${name}.spv)
        set(flags --quiet -V --target-env vulkan1.2 -I${PROJECT_SOURCE_DIR})
        add_custom_command(
            OUTPUT ${module} ${header}
            COMMAND ${GLSLANG_VALIDATOR} ${flags} --depfile ${module}.d -o ${module} ${input}
            COMMAND ${GLSLANG_VALIDATOR} ${flags} --vn ${name}_spirv -o ${header} ${input}
            DEPENDS ${input}
            DEPFILE ${module}.d
            COMMENT "shader ${name}"
            VERBATIM)
        target_sources(${target} PRIVATE ${header})
        if(TWINRAY_BUILD_TESTS)
            add_test(NAME spirv_val.${name}
                     COMMAND ${SPIRV_VAL} --target-env vulkan1.2 --scalar-block-layout ${module})
            set_tests_properties(spirv_val.${name} PROPERTIES LABELS cpu)
        endif()
    endforeach()
    target_include_directories(${target} PRIVATE ${TWINRAY_SPIRV_DIR})
endfunction()
