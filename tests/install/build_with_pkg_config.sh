#!/usr/bin/env bash
# Builds the host by plain compiler commands with what pkg-config says of an installed twinray.
#   build_with_pkg_config.sh CXX PREFIX HOST VOLK OUTPUT     VOLK: folder of volk.c
set -euo pipefail

cxx=$1 prefix=$2 host=$3 volk=$4 output=$5
found=$(find "$prefix" -name twinray.pc)
export PKG_CONFIG_PATH=${found%/*}
read -ra flags <<<"$(pkg-config --cflags twinray vulkan)"
read -ra libraries <<<"$(pkg-config --libs twinray vulkan)"

mkdir -p "$output"
"$cxx" -std=c++20 "${flags[@]}" -c "$host/vma.cpp" -o "$output/vma.o"
"$cxx" -std=c++20 "${flags[@]}" "$host/main.cpp" "$output/vma.o" "${libraries[@]}" -o "$output/host_loader"
"$cxx" -std=c++20 "${flags[@]}" -DVK_NO_PROTOTYPES "$host/main.cpp" "$volk/volk.c" "$output/vma.o" "${libraries[@]}" \
    -o "$output/host_volk"
