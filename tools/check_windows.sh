#!/usr/bin/env bash
# Builds twinray for Windows on Debian 12 or 13 by MinGW-w64, runs its tests by Wine on Mesa's CPU driver, compares what
# its programs write with what those for Linux write, and packs the zips, against which it builds a host. Wine tests the
# port, not Windows' drivers.
#   tools/check_windows.sh          everything, from nothing: it needs root or sudo for packages
#   tools/check_windows.sh quick    the library, the command, the accelerators' common contract, the first comparisons
#   SKIP_APT=1                      install nothing, whatever is missing
#   WINDOWS_PRESET_OPTIONS          further options of CMake
# The exit status is 77 if packages cannot be had, 1 if something is wrong.
# Folders: build/windows-packages (libraries of others), build/windows, build/windows-dll, build/release (for Linux),
# build/wine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/lib.sh

mode=${1-full}
if [[ ! $mode =~ ^(full|quick)$ || $# -gt 1 ]]; then
    echo "usage: tools/check_windows.sh [quick]" >&2
    exit 2
fi
packages=(
    g++-mingw-w64-x86-64-posix libz-mingw-w64-dev wine wine64 xvfb xauth make m4 dpkg-dev googletest zip unzip
)
jobs=${JOBS:-$(nproc)}
display=${WINDOWS_DISPLAY-:164}

install_packages() {
    if [[ ${SKIP_APT-} ]]; then return; fi
    tools/setup.sh
    local missing=() package sudo=()
    for package in "${packages[@]}"; do
        if [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) != installed ]]; then
            missing+=("$package")
        fi
    done
    if ((${#missing[@]} == 0)); then return; fi
    if ((EUID != 0)); then sudo=(sudo); fi
    local install=("${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends)
    "${sudo[@]}" apt-get -qq update || true # the next line says if that matters
    "${install[@]}" --download-only "${missing[@]}" || exit 77
    "${install[@]}" "${missing[@]}"
}

# Wine of Debian 12 has Vulkan only where there is a display, and takes names for UTF-8 only in such a locale.
start_wine() {
    export WINEPREFIX=$PWD/build/wine WINEDEBUG=${WINEDEBUG--all} DISPLAY=$display LC_ALL=C.UTF-8
    Xvfb "$display" -screen 0 1280x1024x24 -fbdir build >build/xvfb.log 2>&1 &
    xvfb=$!
    trap 'kill "$xvfb" 2>/dev/null || true; wineserver -k || true' EXIT
    for ((tries = 0; tries < 100; ++tries)); do
        if (($(cat "/tmp/.X${display#:}-lock" 2>/dev/null || echo 0) == xvfb)); then break; fi
        if ! kill -0 "$xvfb" 2>/dev/null; then break; fi
        sleep 0.1
    done
    if ! kill -0 "$xvfb" 2>/dev/null; then
        echo "check_windows: no Xvfb on display $display: $(<build/xvfb.log)" >&2
        echo "WINDOWS_DISPLAY=:N chooses another display" >&2
        exit 1
    fi
    # Its server stays: a program starts in 0.1 s, not in 1 s, and no process of Wine's keeps its output open for 3 s.
    mkdir -p "$WINEPREFIX"
    wineserver -p >build/wineboot.log 2>&1
    wineboot -i >>build/wineboot.log 2>&1
}

build_windows() {
    local options=() targets=()
    read -r -a options <<<"${WINDOWS_PRESET_OPTIONS-}"
    if [[ $mode == quick ]]; then targets=(--target twinray_cli path_tracer vulkan_tests saved_accel); fi
    cmake --preset windows "${options[@]}" >build/windows-configure.log
    cmake --build build/windows -j "$jobs" "${targets[@]}"
}

build_linux() {
    cmake --preset release >build/linux-configure.log
    cmake --build build/release -j "$jobs" --target twinray_cli path_tracer saved_accel
}

# Only TESTs of GoogleTest: their names have no point. Wine has no layers of Vulkan.
run_tests() {
    local which=(--exclude-regex '\.')
    if [[ $mode == quick ]]; then which+=(--tests-regex '^Every/Accel'); fi
    TWINRAY_WITHOUT_VALIDATION=1 TWINRAY_REQUIRE=vulkan,ray_tracing tools/run_tests.py build/windows "${which[@]}"
}

pack() { # build folder
    rm -rf "$1/packages"
    (cd "$1" && cpack >cpack.log && du -h packages/*.zip)
}

build_dlls() {
    cmake --preset windows -B build/windows-dll -DBUILD_SHARED_LIBS=ON -DTWINRAY_BUILD_PATH_TRACER=OFF \
        -DTWINRAY_BUILD_SAMPLES=OFF -DTWINRAY_BUILD_TESTS=OFF >build/windows-dll-configure.log
    cmake --build build/windows-dll -j "$jobs"
}

# A program outside twinray finds what a zip has, is built against it and traces; so does the command of the zip.
check_zip() { # build folder [option of CMake]...
    local built=$1/host program
    rm -rf "$built"
    mkdir -p "$built"
    unzip -q "$1"/packages/*.zip -d "$built/zip"
    TWINRAY_WINDOWS_PACKAGES=$PWD/build/windows-packages cmake -S tests/install/host -B "$built/build" -G Ninja \
        --toolchain "$PWD/cmake/toolchains/mingw.cmake" -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_PREFIX_PATH="$(echo "$PWD/$built/zip"/*)" "${@:2}" >"$built/configure.log"
    cmake --build "$built/build" -j "$jobs"
    for program in "$built"/build/host_*.exe "$built"/zip/*/bin/twinray.exe; do
        local words=()
        if [[ $program == *twinray.exe ]]; then words=(devices); fi
        WINEPATH=$(echo "$built"/zip/*/bin) wine "$program" "${words[@]}" >"$built/${program##*/}.log"
        echo "runs: ${program##*/}"
    done
}

mkdir -p build
status=0
section "Packages"
install_packages
section "Libraries of others"
JOBS=$jobs tools/windows_packages.sh build/windows-packages
section "Wine $(wine --version)"
start_wine
section "Build for Windows"
build_windows
section "Build for Linux"
build_linux
section "Tests under Wine"
run_tests || status=$?
section "The same as on Linux"
options=()
if [[ $mode == quick ]]; then options=(--quick); fi
python3 tests/windows/same_as_linux.py build/release/bin build/windows/bin "${options[@]}" || status=$?
if [[ $mode == full ]]; then
    section "As users run it"
    python3 tests/windows/as_users_run_it.py build/windows/bin build/Xvfb_screen0 build/window.png || status=$?
    section "Zip"
    pack build/windows
    check_zip build/windows
    section "Zip of DLLs"
    build_dlls
    pack build/windows-dll
    check_zip build/windows-dll -DBUILD_SHARED_LIBS=ON
fi
section_end
exit "$status"
