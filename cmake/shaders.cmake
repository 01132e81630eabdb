# twinray_add_shaders(<target> <pattern>... [EXCEPT <file>...]): compiles each GLSL file under shaders/ that a pattern
# names to SPIR-V at build time and gives <target> a header per file, "<folder>_<stem>.spv.h" with
# `const uint32_t <folder>_<stem>_spirv[]` (ray tracing stages keep their suffix: <folder>_<stem>_rgen).
include(${CMAKE_CURRENT_LIST_DIR}/TwinrayShaders.cmake)

function(twinray_add_shaders target)
    cmake_parse_arguments(arg "" "" "EXCEPT" ${ARGN})
    list(TRANSFORM arg_UNPARSED_ARGUMENTS PREPEND ${PROJECT_SOURCE_DIR}/shaders/ OUTPUT_VARIABLE patterns)
    file(GLOB sources CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/shaders ${patterns})
    foreach(source ${sources})
        if(source IN_LIST arg_EXCEPT)
            continue()
        endif()
        get_filename_component(folder ${source} DIRECTORY)
        get_filename_component(stem ${source} NAME_WE)
        get_filename_component(extension ${source} LAST_EXT)
        set(name ${folder}_${stem})
        if(NOT extension STREQUAL ".comp")
            string(REPLACE "." "_" suffix ${extension})
            string(APPEND name ${suffix})
        endif()
        twinray_compile_shader(${target} ${name} ${PROJECT_SOURCE_DIR}/shaders/${source})
    endforeach()
endfunction()

# twinray_validate_shaders(<target>...): with tests on, a ctest for each module that the target was given.
function(twinray_validate_shaders)
    foreach(target ${ARGN})
        get_target_property(modules ${target} TWINRAY_SPIRV)
        foreach(module ${modules})
            get_filename_component(name ${module} NAME_WE)
            add_test(
                NAME spirv_val.${name}
                COMMAND ${SPIRV_VAL} --target-env vulkan1.2 --scalar-block-layout ${module}
            )
            set_tests_properties(spirv_val.${name} PROPERTIES LABELS cpu)
        endforeach()
    endforeach()
endfunction()
