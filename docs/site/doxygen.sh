#!/usr/bin/env bash
# Makes Doxygen's XML of the public headers; what Doxygen says is a warning, so nothing may be said.
# Usage: doxygen.sh cpp|glsl FOLDER   FOLDER/xml becomes it
set -euo pipefail
site=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$site/../.."

case ${1-} in
cpp) input=include/twinray words=AMD_VULKAN_MEMORY_ALLOCATOR_H ;;
glsl)
    input=include/twinray/glsl
    words='"layout(x)=" "REF(T)=T##_ref" FUNC= PRECISE= "INOUT(T)=inout T" "BUFFER_OF(T,a)=" "REFERENCE(a,b,c,d)="'
    words+=' "FEATURE(id,name)=const bool name = true;" "spirv_instruction(a,b)=" TWINRAY_SW TWINRAY_PROGRAM'
    ;;
*)
    echo "doxygen.sh: what is '${1-}'? usage: doxygen.sh cpp|glsl FOLDER" >&2
    exit 2
    ;;
esac
mkdir -p "$2"
rm -rf "${2:?}/xml"
{
    cat docs/site/Doxyfile
    printf 'OUTPUT_DIRECTORY = %s\nINPUT = %s\nPREDEFINED = %s\n' "$2" "$input" "$words"
} | doxygen - >/dev/null 2>"$2/warnings.txt"
if [[ -s $2/warnings.txt ]]; then
    cat "$2/warnings.txt" >&2
    exit 1
fi
