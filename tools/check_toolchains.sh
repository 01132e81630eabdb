#!/usr/bin/env bash
# Builds this checkout with the oldest and the newest compilers and libraries that it is for, with warnings as errors, and
# runs the tests of `tools/test.sh quick`, each in a room (tools/lib.sh). Ends with a table. Exit status 1: one failed.
#   tools/check_toolchains.sh [--rooms FOLDER] [NAME...]
#     NAME       gcc-oldest, clang-oldest (Debian 12's), gcc-newest, clang-newest (the newest of sid); default:
#                all of them
#     --rooms    default: build/rooms; rooms and their builds stay there. Remove one to make it again.
# Needs root, debootstrap and 12 GB.
set -euo pipefail

rooms=''
if [[ ${1-} == --rooms && $# -ge 2 ]]; then
    rooms=$(realpath -m "$2")
    shift 2
fi
names=("$@")
if ((${#names[@]} == 0)); then names=(gcc-oldest clang-oldest gcc-newest clang-newest); fi
for name in "${names[@]}"; do
    if [[ ! $name =~ ^(gcc|clang)-(oldest|newest)$ ]]; then
        echo "usage: tools/check_toolchains.sh [--rooms FOLDER]" \
            "[gcc-oldest|clang-oldest|gcc-newest|clang-newest]..." >&2
        exit 2
    fi
done
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/lib.sh
can_make_rooms
rooms=${rooms:-$PWD/build/rooms}

# The package of the compiler: the release's own, or the last by number.
compiler_package() { # name, room
    local package=${1%-*}
    package=${package/gcc/g++}
    if [[ $1 == *-newest ]]; then
        package=$(in_room "$2" "apt-cache search --names-only '^${package//+/\\+}-[0-9]+\$'" | sort -V | tail -n 1)
    fi
    echo "${package%% *}"
}

# Prints the versions of a room's tools.
# shellcheck disable=SC2016
versions='echo "$("$CXX" -dumpfullversion -dumpversion)," \
    "CMake $(cmake --version | sed -n "1s/.* //p"), glslang $(dpkg-query -W -f "\${Version}" glslang-tools)"'

check() { # name
    local suite=bookworm room log package compiler start=$SECONDS result=passed warnings
    section "$1"
    if [[ $1 == *-newest ]]; then suite=sid; fi
    room=$rooms/toolchains-$suite
    log=$rooms/$1.log
    if [[ ! -e $room/complete ]]; then
        rm -rf --one-file-system "$room"
        make_room "$room" "$suite" && touch "$room/complete" || return
    fi
    copy_checkout "$room/$1"
    in_room "$room" "cd /$1 && tools/setup.sh" || return
    package=$(compiler_package "$1" "$room")
    install_in_room "$room" "$package" || return
    compiler="export CC=${package/g++/gcc} CXX=${package/clang/clang++}"
    in_room "$room" "$compiler SKIP_APT=1 TWINRAY_WERROR=ON; cd /$1 && nice tools/test.sh quick" >"$log" 2>&1 || {
        result="FAILED ($?)"
        tail -n 100 "$log"
    }
    warnings=$(grep -ciE '(^| )warning[: ]' "$log" || true)
    if ((warnings)); then result=FAILED; fi
    rows+=("$(row "$1" "$package $(in_room "$room" "$compiler; $versions")" "$warnings" \
        "$(sed -n 's/^tests: //p' "$log")" \
        $((SECONDS - start)) "$result")")
    [[ $result == passed ]]
}

row() { printf '%-13s %-50s %8s %36s %7s  %s\n' "$@"; }

rows=()
status=0
for name in "${names[@]}"; do
    check "$name" || status=1
done
section "Toolchains"
row toolchain versions warnings tests seconds ''
printf '%s\n' "${rows[@]}"
exit "$status"
