# twinray_add_shaders(<target> <pattern>... [EXCEPT <file>...]): compiles each GLSL file under shaders/ that a pattern
# names to SPIR-V at build time and gives <target> a header per module, "<folder>_<stem>.spv.h" with
# `const uint32_t <folder>_<stem>_spirv[]`. A file may be several modules: "#ifdef KERNEL_<NAME>" makes the kernel
# <folder>_<name> of it, "#ifdef STAGE_<NAME>" the stage <folder>_<stem>_<name> of a ray tracing pipeline.
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
        set(file ${PROJECT_SOURCE_DIR}/shaders/${source})
        file(STRINGS ${file} parts REGEX "^#ifdef (KERNEL|STAGE)_")
        if(NOT parts)
            twinray_compile_shader(${target} ${folder}_${stem} ${file})
        endif()
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
        foreach(part ${parts})
            string(REGEX REPLACE "^#ifdef " "" macro ${part})
            string(REGEX REPLACE "^(KERNEL|STAGE)_" "" name ${macro})
            string(TOLOWER ${name} name)
            if(macro MATCHES "^STAGE_")
                twinray_compile_shader(${target} ${folder}_${stem}_${name} ${file} -S ${name} -D${macro})
            else()
                twinray_compile_shader(${target} ${folder}_${name} ${file} -D${macro})
            endif()
        endforeach()
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
