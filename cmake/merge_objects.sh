#!/usr/bin/env bash
# Links object files into one in which only strong symbols of namespace twinray, and the tables of its classes, are
# global; every other becomes local.
#   cmake/merge_objects.sh LINKER NM OBJCOPY OUTPUT.o INPUT.o...
set -euo pipefail

linker=$1 nm=$2 objcopy=$3 output=$4
shift 4
merged=$output.merged exports=$output.exports
if [[ $("$linker" --help 2>&1) != *--force-group-allocation* ]]; then
    echo "merge_objects: $linker knows no --force-group-allocation:" \
        "set CMAKE_LINKER to GNU ld, or to LLD 19 or newer" >&2
    exit 1
fi
# Groups are removed: a linker drops a group that a host's object also has, and twinray's local names would dangle.
"$linker" -r --force-group-allocation -o "$merged" "$@"
"$nm" --extern-only --defined-only --no-demangle "$merged" |
    awk '$2 ~ /[TDBR]/ && $3 ~ /^_ZNK?7twinray/ { print $3 }
         $2 ~ /[DRV]/ && $3 ~ /^_ZT[ISTV]N7twinray/ { print $3 }' >"$exports"
"$objcopy" --keep-global-symbols="$exports" "$merged" "$output"
rm "$merged" "$exports"
