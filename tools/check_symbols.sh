#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Fails if a static library defines a global symbol named like a Vulkan function: it would take over that function
# in every program that links both the library and the Vulkan loader.
#   tools/check_symbols.sh LIBRARY.a...
set -euo pipefail

if (($# == 0)); then
    echo "usage: tools/check_symbols.sh LIBRARY.a..." >&2
    exit 2
fi
symbols=$(nm -A -g --defined-only "$@")
if clashes=$(grep -E ' vk[A-Z][A-Za-z0-9_]*$' <<<"$symbols"); then
    printf '%s\n' "$clashes"
    echo "check_symbols: the symbols above would shadow the Vulkan loader's" >&2
    exit 1
fi
echo "check_symbols: no symbol named vk* in $*"
