#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Fails if a library makes anything global that is not of namespace twinray, or a weak function. Else it would clash
# with a host that has its own Vulkan loader, volk, Vulkan Memory Allocator, stb or tinygltf, and an inline function
# that the host compiled with other options could replace twinray's.
#   tools/check_symbols.sh LIBRARY.a|LIBRARY.so...
set -euo pipefail

if (($# == 0)); then
    echo "usage: tools/check_symbols.sh LIBRARY.a|LIBRARY.so..." >&2
    exit 2
fi
ours='[TDBR] _ZNK?7twinray|[TDBRV] _ZT[ISTV]N7twinray'
for library in "$@"; do
    if [[ $library == *.a ]]; then table=--extern-only; else table=--dynamic; fi
    symbols=$(nm "$table" --defined-only --no-demangle "$library" | grep -E '^[0-9a-f]+ ')
    if clashes=$(grep -vE "^[0-9a-f]+ ($ours)" <<<"$symbols"); then
        c++filt <<<"$clashes"
        echo "check_symbols: the symbols above are global in $library and should not be" >&2
        exit 1
    fi
    echo "check_symbols: all $(wc -l <<<"$symbols") symbols of $library are of namespace twinray, and none is inline"
done
