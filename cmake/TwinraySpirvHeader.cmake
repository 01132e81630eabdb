# Writes a SPIR-V module as a C++ header with `const uint32_t <NAME>[]`, its little-endian words:
#   cmake -DMODULE=FILE.spv -DNAME=name -DHEADER=FILE.h -P TwinraySpirvHeader.cmake
file(READ ${MODULE} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${bytes}")
string(REPEAT "." 88 line)
string(REGEX REPLACE "(${line})" "\\1\n" words "${words}")
file(WRITE ${HEADER} "#pragma once\n#include <cstdint>\n\nconst uint32_t ${NAME}[] = {\n${words}\n};\n")
