#!/usr/bin/env bash
# Gives Vulkan Memory Allocator, stb and tinygltf names of twinray's in objects for Windows, so that a host may have
# its own. Made local, as on Linux, they could not be linked: a linker drops all inline functions of a name but one.
#   cmake/rename_symbols_of_others.sh NM OBJCOPY OBJECT...
set -euo pipefail

nm=$1
objcopy=$2
shift 2
names=$(mktemp)
trap 'rm -f "$names"' EXIT
"$nm" --format=just-symbols "$@" 2>/dev/null |
    awk '/^(\.refptr\.)?(vma[A-Z]|stbi)/ || (/^(\.refptr\.)?_Z/ && /Vma[A-Z]|8tinygltf/ && !/7twinray/) {
             print $1, "twinray_" $1
         }' |
    sort -u >"$names"
if [[ ! -s $names ]]; then exit 0; fi
# Keeps the dates: with newer ones, ninja would compile the objects again.
for object in "$@"; do "$objcopy" --preserve-dates --redefine-syms="$names" "$object"; done
