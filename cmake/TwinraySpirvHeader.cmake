# SPDX-License-Identifier: MIT
# Writes a compiled SPIR-V module, optimised, as a module and as a C++ header with `const uint32_t <NAME>[]`, its
# little-endian words:
#   cmake -DSPIRV_OPT=PROGRAM -DCOMPILED=FILE.spv -DMODULE=FILE.spv -DNAME=name -DHEADER=FILE.h
#         -P TwinraySpirvHeader.cmake
# Functions are inlined and variables become values before a driver sees a module, which then takes a third to a half of
# the time to compile it, into the same code (docs/decisions.md). No pass touches arithmetic: `precise` stays.
set(passes
    --inline-entry-points-exhaustive
    --eliminate-dead-functions
    --private-to-local
    --scalar-replacement=100
    --convert-local-access-chains
    --eliminate-local-single-block
    --eliminate-local-single-store
    --ssa-rewrite
    --eliminate-dead-inserts
    --eliminate-dead-code-aggressive
    --merge-blocks
)
# It warns of each function with two returns that it leaves as it is. That of SPIRV-Tools 2025.1 first refuses arrays
# that scalarBlockLayout allows, unless it is told of that feature.
execute_process(
    COMMAND ${SPIRV_OPT} --scalar-block-layout ${passes} ${COMPILED} -o ${MODULE}
    RESULT_VARIABLE result
    OUTPUT_VARIABLE said
    ERROR_VARIABLE said
)
if(NOT result EQUAL 0)
    message(FATAL_ERROR "${SPIRV_OPT} ${COMPILED}: ${result}\n${said}")
endif()
file(READ ${MODULE} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${bytes}")
string(REPEAT "." 88 line)
string(REGEX REPLACE "(${line})" "\\1\n" words "${words}")
file(WRITE ${HEADER} "#pragma once\n#include <cstdint>\n\nconst uint32_t ${NAME}[] = {\n${words}\n};\n")
