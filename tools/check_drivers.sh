#!/usr/bin/env bash
# Runs the programs and tests that are built on other Vulkan drivers than this machine's: each has a room, a minimal
# Debian with nothing else (tools/lib.sh). Ends with a table. Exit status 1: something failed on one of them; 77: a
# room could not be made, for the printed reason.
#   tools/check_drivers.sh [--quick] [--build FOLDER] [--rooms FOLDER] [NAME...]
#     NAME       mesa-25.0 (backports of Debian 12), mesa-26.1 (of Debian 13), mesa-26.2 (sid), swiftshader
#                (chromium-common of Debian 12), default: all; newest, testing: those that sid and Debian
#                testing have. The table names their versions.
#     --quick    the contract, verify, leaks and the conformance suite: minutes
#     --build    default: build/release
#     --rooms    default: build/rooms; rooms stay there. A missing room is made in two minutes.
# Needs root and debootstrap. Libraries of this machine that the programs need, and a room lacks, are copied into it.
set -euo pipefail

declare -A suites=([mesa-25.0]=bookworm-backports [mesa-26.1]=trixie-backports [mesa-26.2]=sid [newest]=sid
    [testing]=testing [swiftshader]=bookworm)
quick=0 build='' rooms=''
while [[ ${1-} == --* ]]; do
    case $1 in
    --quick) quick=1 ;;
    --build) build=$(realpath "$2") && shift ;;
    --rooms) rooms=$(realpath -m "$2") && shift ;;
    *) set -- unknown ;;
    esac
    shift
done
names=("$@")
if ((${#names[@]} == 0)); then names=(mesa-25.0 mesa-26.1 mesa-26.2 swiftshader); fi
for name in "${names[@]}"; do
    if [[ ! ${suites[$name]-} ]]; then
        echo "usage: tools/check_drivers.sh [--quick] [--build FOLDER] [--rooms FOLDER] [NAME...]" \
            "with names of: ${!suites[*]}" >&2
        exit 2
    fi
done
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/lib.sh
can_make_rooms || exit 77
build=${build:-$PWD/build/release}
rooms=${rooms:-$PWD/build/rooms}
if [[ ! -x $build/bin/twinray || ! -x $build/bin/vulkan_tests ]]; then
    echo "check_drivers: no programs and tests in $build: tools/test.sh builds them" >&2
    exit 1
fi
cached() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }
source_folder=$(cached CMAKE_HOME_DIRECTORY)
python=$(cached _Python3_EXECUTABLE)

# Makes a driver's room, if there is none, with the programs that tests need.
furnish() { # room, suite, driver
    local packages=(cmake python3 gcc libc6-dev libvulkan-dev vulkan-validationlayers xvfb xauth gnuplot-nox
        assimp-testmodels)
    if [[ $(cat "$1/furnished" 2>/dev/null) == "${packages[*]}" ]]; then return; fi
    rm -rf --one-file-system "$1"
    make_room "$1" "$2" && install_in_room "$1" "${packages[@]}" || return
    case $3:$2 in
    swiftshader:*) install_in_room "$1" chromium-common ;;
    *-backports) install_in_room "$1" -t "$2" mesa-vulkan-drivers ;;
    *) install_in_room "$1" mesa-vulkan-drivers ;;
    esac && echo "${packages[*]}" >"$1/furnished"
}

# Copies the libraries that programs of the build load here, and the room has not; the tests' Python is the room's.
lend() { # room
    local library present
    rm -rf "$1/lent"
    mkdir "$1/lent"
    present=$(in_room "$1" 'ldconfig -p') || return
    while read -r library; do
        if [[ $present != *$'\t'"${library##*/} "* ]]; then cp -L "$library" "$1/lent"; fi
    done < <(find "$build/bin" -type f -exec ldd {} + 2>/dev/null | awk '$3 ~ /^\// { print $3 }' | sort -u)
    if [[ ! -e $1$python ]]; then
        install -D /dev/stdin -m 755 "$1$python" <<<$'#!/bin/sh\nexec /usr/bin/python3 "$@"'
    fi
}

# Runs a line in a room with the build; its output goes to a file, and here if it fails.
on_driver() { # room, file, line
    in_room "$1" "export LD_LIBRARY_PATH=/lent $environment; cd /tmp; PATH=$build/bin:\$PATH; $3" \
        "$source_folder" "$build" >"$2" 2>&1 || {
        printf 'FAILED (%d): %s\n' $? "$3"
        grep -vE '^ +Start +[0-9]+: | Passed +[0-9.]+ sec$' "$2" | tail -n 200
        return 1
    }
}

check() { # name
    local room=$rooms/${suites[$1]} start=$SECONDS counts version labels='quick|vulkan' log conformance='' report='-'
    local package=mesa-vulkan-drivers environment='TWINRAY_REQUIRE=vulkan,ray_tracing,descriptor_indexing'
    section "$1"
    if ! { furnish "$room" "${suites[$1]}" "$1" && lend "$room"; }; then
        rows+=("$(row "$1" 'no room' - - - - $((SECONDS - start)) 'not tried')")
        return 77
    fi
    echo "its room took $((SECONDS - start)) s"
    if [[ $1 == swiftshader ]]; then
        package=chromium-common
        environment='TWINRAY_REQUIRE=vulkan VK_DRIVER_FILES=/usr/lib/chromium/vk_swiftshader_icd.json'
        labels=swiftshader # suites that it can carry out: docs/requirements.md
    elif ((quick)); then
        labels=quick
    fi
    version=$(in_room "$room" "dpkg-query -W -f '\${Version}' $package")
    log=$room/output
    mkdir -p "$log"
    local good=1
    start=$SECONDS
    # A room has no CMake hosts, no documentation and no Python package.
    on_driver "$room" "$log/tests.txt" \
        "$source_folder/tools/run_tests.py $build -L '$labels' -E '^(install|docs)\.|python'" || good=0
    counts=$(sed -nE 's/^tests: ([0-9]+) passed, ([0-9]+) failed, ([0-9]+) skipped$/\1 \2 \3/p' "$log/tests.txt")
    on_driver "$room" "$log/conformance.txt" "twinray verify --suite conformance" || good=0
    conformance=$(sed -nE 's/^([0-9]+ of [0-9]+) cases pass.*/\1/p' "$log/conformance.txt")
    if ((quick)); then
        printf 'v %s\n' '0 0 0' '1 0 0' '0 1 0' '0 0 1' >"$log/closed.obj"
        printf 'f %s\n' '1 3 2' '1 2 4' '1 4 3' '2 3 4' >>"$log/closed.obj"
        on_driver "$room" "$log/verify.txt" \
            "twinray verify $source_folder/tests/samples/peers/cornell_box.gltf --random 10000 --aimed 1000" || good=0
        on_driver "$room" "$log/leaks.txt" "twinray leaks /output/closed.obj --accel sw --ray-count 1e5" || good=0
    else
        on_driver "$room" "$log/report.txt" "twinray report -o /output/report" || good=0
        report=$(sed -n '/^This driver/p; s/^  \(.*pass [0-9]*\)$/(\1)/p' "$log/report.txt" | tr '\n' ' ')
    fi
    # shellcheck disable=SC2046,SC2086
    rows+=("$(row "$1" "$version" ${counts:-- - -} "${conformance:-FAILED}" $((SECONDS - start)) \
        "$( ((good)) && echo passed || echo FAILED)")")
    if ((!quick)); then rows+=("  report: ${report:-FAILED}"); fi
    rows+=("$(sed -nE 's/^((failed|skipped, [0-9]+): )/  \1/p' "$log/tests.txt")")
    ((good))
}

row() { printf '%-11s %-22s %6s %6s %7s  %-12s %7s  %s\n' "$@"; }

rows=()
status=0
for name in "${names[@]}"; do
    check "$name" || { (($? == 77)) && ((status != 1)) && status=77; } || status=1
done
section "Drivers"
row driver version passed failed skipped conformance seconds ''
printf '%s\n' "${rows[@]}" | grep -v '^$'
exit "$status"
