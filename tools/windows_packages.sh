#!/usr/bin/env bash
# Makes a folder with all that twinray takes from others, for Windows: libraries of Debian's source packages, compiled by
# MinGW-w64, and Debian's headers that need no library.
#   tools/windows_packages.sh FOLDER    FOLDER/done is the last thing that it writes; it does nothing if that is there,
#                                       by the same script and options
#   WINDOWS_SOURCES    source packages: NAME, or NAME/RELEASE for one of another release where a mirror lacks the
#                      running one's: "gmp imath/bookworm openexr/bookworm glfw3 imgui"
# apt-get source must be able to fetch, so the script brings its own list of sources. The exit status is 77 if they
# cannot be had.
set -euo pipefail

folder=$(realpath -m "${1:?usage: tools/windows_packages.sh FOLDER}")
target=x86_64-w64-mingw32
jobs=${JOBS:-$(nproc)}
toolchain=$(dirname "$(realpath "$0")")/../cmake/toolchains/mingw.cmake
sources=$folder/sources
# These packages consist of headers alone.
header_packages=(
    libvulkan-dev libvulkan-volk-dev libvulkan-memory-allocator-dev libglm-dev nlohmann-json3-dev libcli11-dev
    libeigen3-dev libtinygltf-dev libstb-dev
)
read -r -a source_packages <<<"${WINDOWS_SOURCES-gmp imath openexr glfw3 imgui}"

made_by=$(
    {
        cat "$0" "$toolchain" /etc/os-release
        dpkg-query -W "${header_packages[@]}" g++-mingw-w64-x86-64-posix libz-mingw-w64-dev
        echo "${source_packages[*]}"
    } | sha256sum
)
if [[ $(cat "$folder/done" 2>/dev/null) == "$made_by" ]]; then exit 0; fi
rm -rf "${folder:?}"/{done,include,lib,share,licenses,sources,apt} # left by another script, or by a run that failed
export TWINRAY_WINDOWS_PACKAGES=$folder

say() { printf 'windows_packages: %s\n' "$*"; }

copy_headers() {
    local files file
    files=$(dpkg -L "${header_packages[@]}")
    while read -r file; do
        if [[ -f $file ]]; then install -Dm644 "$file" "$folder/${file#/usr/}"; fi
    done < <(grep -E '^/usr/(include|share/cmake|share/eigen3)/' <<<"$files")
}

# Copies Debian's texts of their licences.
copy_licenses() {
    local package source
    mkdir -p "$folder/licenses"
    for package in "${header_packages[@]}" g++-mingw-w64-x86-64-posix libz-mingw-w64-dev; do
        cp -L "/usr/share/doc/$package/copyright" "$folder/licenses/$package.txt"
    done
    for source in "$sources"/*/; do cp "$source/debian/copyright" "$folder/licenses/$(basename "$source").txt"; done
}

fetch_sources() {
    local apt=$folder/apt release mirror package suites=()
    release=$(. /etc/os-release && echo "$VERSION_CODENAME")
    # The mirror that this system takes its packages from; apt-get expands what is in quotes.
    # shellcheck disable=SC2016
    mirror=$(apt-get indextargets --format '$(CODENAME) $(REPO_URI)' 'Origin: Debian' |
        sed -n "s/^$release //p" | sort -u | head -n 1)
    if [[ -z $mirror ]]; then
        say "apt knows no mirror of Debian $release; run apt-get update" >&2
        exit 77
    fi
    suites=("$release")
    for package in "${source_packages[@]}"; do
        if [[ $package == */* ]]; then suites+=("${package#*/}"); fi
    done
    mkdir -p "$apt/lists/partial" "$apt/lists.d"
    cat >"$apt/lists.d/debian.sources" <<END
Types: deb-src
URIs: $mirror
Suites: ${suites[*]}
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg
END
    local options=(-qq -o Acquire::Retries=3 -o "Dir::Etc::sourceparts=$apt/lists.d" -o Dir::Etc::sourcelist=/dev/null
        -o "Dir::State::lists=$apt/lists" -o APT::Sandbox::User=root)
    apt-get "${options[@]}" update || exit 77
    rm -rf "$sources" # left by a run that failed
    mkdir -p "$sources"
    (cd "$sources" && apt-get "${options[@]}" source --download-only "${source_packages[@]}") || exit 77
    for package in "$sources"/*.dsc; do dpkg-source --no-check -x "$package" "${package%.dsc}" >/dev/null; done
}

source_of() { echo "$sources/$1"_*/; } # a package

build_with_cmake() { # SOURCE [OPTION]...
    local source=$1
    shift
    cmake -S "$source" -B "$source/build-windows" -G Ninja -Wno-dev --no-warn-unused-cli --toolchain "$toolchain" \
        -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$folder" -DCMAKE_POLICY_VERSION_MINIMUM=3.5 \
        -DBUILD_SHARED_LIBS=OFF -DBUILD_TESTING=OFF "$@" >"$source/configure.log"
    ninja -C "$source/build-windows" -j "$jobs" install >"$source/build.log"
}

build_gmp() {
    local source
    source=$(source_of gmp)
    # Debian's source has no manual.
    mkdir -p "$source/doc"
    printf 'all install check:\n' >"$source/doc/Makefile.in"
    (cd "$source" && ./configure --host="$target" --prefix="$folder" --enable-cxx --disable-shared --enable-static \
        CC="$target-gcc-posix" CXX="$target-g++-posix" CC_FOR_BUILD=gcc >configure.log &&
        make -j "$jobs" >build.log && make install >>build.log)
}

build_imgui() {
    local source objects=() file name
    source=$(source_of imgui)
    mkdir -p "$source/build-windows" "$folder/include/imgui/backends" "$folder/lib"
    for file in "$source"/imgui*.cpp "$source"/backends/imgui_impl_{glfw,vulkan}.cpp; do
        name=$source/build-windows/$(basename "$file" .cpp).o
        "$target-g++-posix" -O2 -w -I"$source" -I"$folder/include" -c "$file" -o "$name"
        objects+=("$name")
    done
    "$target-ar" rcs "$folder/lib/libimgui.a" "${objects[@]}"
    # Debian's imgui leaves its fonts to a library of stb.
    cat >"$source/build-windows/stb.c" <<END
#define STB_RECT_PACK_IMPLEMENTATION
#include <stb/stb_rect_pack.h>
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>
END
    "$target-gcc-posix" -O2 -I"$folder/include" -c "$source/build-windows/stb.c" -o "$source/build-windows/stb.o"
    "$target-ar" rcs "$folder/lib/libstb.a" "$source/build-windows/stb.o"
    cp "$source"/im*.h "$folder/include/imgui/"
    cp "$source"/backends/imgui_impl_{glfw,vulkan}.h "$folder/include/imgui/backends/"
}

# The window links Vulkan's loader, of which Windows has the DLL alone.
make_vulkan_library() {
    local library
    library=$(PATH=$PATH:/usr/sbin:/sbin ldconfig -p | awk '$1 == "libvulkan.so.1" && !seen++ { print $NF }')
    { echo "LIBRARY vulkan-1.dll" && echo EXPORTS && nm -D --defined-only "$library" | awk '$3 ~ /^vk/ { print $3 }'; } |
        sed 's/@.*//' >"$folder/vulkan-1.def"
    "$target-dlltool" -d "$folder/vulkan-1.def" -l "$folder/lib/libvulkan-1.dll.a"
}

say "headers of Debian"
copy_headers
say "sources of Debian"
fetch_sources
copy_licenses
say "GMP"
build_gmp
say "Imath"
build_with_cmake "$(source_of imath)"
say "OpenEXR"
build_with_cmake "$(source_of openexr)" -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF
say "GLFW"
build_with_cmake "$(source_of glfw3)" -DGLFW_BUILD_EXAMPLES=OFF -DGLFW_BUILD_TESTS=OFF -DGLFW_BUILD_DOCS=OFF
say "Dear ImGui"
build_imgui
say "GoogleTest"
cp -r /usr/src/googletest "$sources/googletest"
build_with_cmake "$sources/googletest" -DBUILD_GMOCK=OFF
make_vulkan_library
echo "$made_by" >"$folder/done"
say "done: $folder"
