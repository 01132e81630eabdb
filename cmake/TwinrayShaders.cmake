# SPDX-License-Identifier: MIT
# Compiles GLSL for twinray, in its own build and in that of a host that found it. Each function gives <target> headers,
# to be included by name:
#
#   twinray_add_kernel(<target> <name> <file> [REFINED])   a compute kernel that includes twinray/glsl/query.glsl, once
#                                                      for each accelerator, REFINED with the levels that need
#                                                      float64: "<name>_sw.spv.h" with <name>_sw_spirv[], and
#                                                      "<name>_hw.spv.h" with <name>_hw_spirv[]
#   twinray_add_trace_program(<target> <name> <file>)  intersect_primitive and accept_hit, compiled into each way of
#                                                      tracing: "<name>.trace_program.h" with the TraceProgramCode <name>
#   twinray_compile_shader(<target> <name> <file> [option...])   "<name>.spv.h" with <name>_spirv[]; further options
#                                                      of glslangValidator
find_program(TWINRAY_GLSLANG_VALIDATOR glslangValidator DOC "compiler of GLSL to SPIR-V, of package glslang-tools")
find_program(TWINRAY_SPIRV_OPT spirv-opt DOC "optimiser of SPIR-V, of package spirv-tools")

# Finds "twinray/glsl/query.glsl" and the "shaders/shared/..." that it needs: in the source tree, or installed.
get_filename_component(twinray_root ${CMAKE_CURRENT_LIST_DIR}/.. ABSOLUTE)
if(EXISTS ${twinray_root}/include/twinray/glsl/query.glsl)
    set(TWINRAY_SHADER_FOLDERS ${twinray_root} ${twinray_root}/include CACHE INTERNAL "")
else()
    set(TWINRAY_SHADER_FOLDERS ${TWINRAY_INCLUDE_DIR}/twinray/glsl ${TWINRAY_INCLUDE_DIR} CACHE INTERNAL "")
endif()

set(TWINRAY_SPIRV_HEADER_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/TwinraySpirvHeader.cmake CACHE INTERNAL "")

function(twinray_compile_shader target name input)
    if(NOT TWINRAY_GLSLANG_VALIDATOR OR NOT TWINRAY_SPIRV_OPT)
        message(
            FATAL_ERROR
            "twinray: shader ${name} needs glslangValidator and spirv-opt "
            "(Debian: apt-get install glslang-tools spirv-tools)"
        )
    endif()
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/spirv)
    file(MAKE_DIRECTORY ${folder}/glslang)
    set(flags
        --quiet
        -V
        --target-env
        vulkan1.2
        ${ARGN}
    )
    foreach(include ${TWINRAY_SHADER_FOLDERS})
        list(APPEND flags -I${include})
    endforeach()
    set(compiled ${folder}/glslang/${name}.spv)
    set(module ${folder}/${name}.spv)
    set(header ${folder}/${name}.spv.h)
    add_custom_command(
        OUTPUT ${compiled} ${module} ${header}
        COMMAND ${TWINRAY_GLSLANG_VALIDATOR} ${flags} --depfile ${compiled}.d -o ${compiled} ${input}
        COMMAND
            ${CMAKE_COMMAND} -DSPIRV_OPT=${TWINRAY_SPIRV_OPT} -DCOMPILED=${compiled} -DMODULE=${module}
            -DNAME=${name}_spirv -DHEADER=${header} -P ${TWINRAY_SPIRV_HEADER_SCRIPT}
        DEPENDS ${input} ${TWINRAY_SPIRV_HEADER_SCRIPT}
        DEPFILE ${compiled}.d
        COMMENT "shader ${name}"
        VERBATIM
    )
    target_sources(${target} PRIVATE ${header})
    target_include_directories(${target} PRIVATE ${folder})
    set_property(TARGET ${target} APPEND PROPERTY TWINRAY_SPIRV ${module})
    set_property(GLOBAL APPEND PROPERTY TWINRAY_ALL_SPIRV ${module})
endfunction()

function(twinray_add_kernel target name file)
    get_filename_component(input ${file} ABSOLUTE)
    set(flags "")
    if("REFINED" IN_LIST ARGN)
        set(flags -DTWINRAY_REFINED)
    endif()
    twinray_compile_shader(${target} ${name}_sw ${input} -DTWINRAY_SW ${flags})
    twinray_compile_shader(${target} ${name}_hw ${input} -DTWINRAY_HW ${flags})
endfunction()

function(twinray_add_trace_program target name file)
    get_filename_component(input ${file} ABSOLUTE)
    get_filename_component(beside ${input} DIRECTORY)
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/spirv/${name})
    configure_file(${input} ${folder}/twinray_program.glsl COPYONLY)
    list(GET TWINRAY_SHADER_FOLDERS 0 root)
    set(flags -DTWINRAY_PROGRAM -I${folder} -I${beside})
    twinray_compile_shader(${target} ${name}_sw ${root}/shaders/engine/trace.comp ${flags} -DTWINRAY_SW)
    twinray_compile_shader(${target} ${name}_hw ${root}/shaders/engine/trace.comp ${flags} -DTWINRAY_HW)
    twinray_compile_shader(${target} ${name}_sw_refined ${root}/shaders/engine/trace.comp ${flags} -DTWINRAY_SW
        -DTWINRAY_REFINED
    )
    twinray_compile_shader(${target} ${name}_hw_refined ${root}/shaders/engine/trace.comp ${flags} -DTWINRAY_HW
        -DTWINRAY_REFINED
    )
    twinray_compile_shader(${target} ${name}_rahit ${root}/shaders/hwtlas/trace.glsl ${flags} -S rahit
        -DSTAGE_RAHIT
    )
    twinray_compile_shader(${target} ${name}_rint ${root}/shaders/hwtlas/trace.glsl ${flags} -S rint
        -DSTAGE_RINT
    )
    file(
        CONFIGURE
        OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/spirv/${name}.trace_program.h
        @ONLY
        CONTENT
            [[
#pragma once
#include <cstdint>

#include "@name@_hw.spv.h"
#include "@name@_hw_refined.spv.h"
#include "@name@_rahit.spv.h"
#include "@name@_rint.spv.h"
#include "@name@_sw.spv.h"
#include "@name@_sw_refined.spv.h"
#include <twinray/trace.h>

inline const twinray::TraceProgramCode @name@{"@name@",         @name@_sw_spirv,    @name@_sw_refined_spirv,
                                              @name@_hw_spirv, @name@_hw_refined_spirv,
                                              @name@_rahit_spirv, @name@_rint_spirv};
]]
    )
endfunction()
