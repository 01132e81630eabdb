#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: spirv-opt optimises whatever module it is given, and checking is what spirv-val is for.
# Seen: spirv-opt validates the module first, without an option for that. An array of 24-byte structs, which Vulkan
# 1.2's scalarBlockLayout allows, is then refused by SPIRV-Tools 2025.1 for the default target, universal; 2026.4
# takes it there and refuses it with --target-env=vulkan1.2 alone. Both take it with --scalar-block-layout.
# Seen with spirv-tools 2025.1~rc1-1, 2026.4~rc2-1 and glslang-tools 16.6.0-1 on 2026-11-28.
folder=$(mktemp -d)
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_room sid
install glslang-tools=16.6.0-1 spirv-tools=2026.4~rc2-1
older=2025.1~rc1-1
unpack trixie spirv-tools "$older"

cat >"$probe/scalar.comp" <<'END'
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 1) in;
struct Item { float x, y; vec4 color; };
layout(buffer_reference, scalar) buffer Items { Item at[]; };
layout(push_constant) uniform Arguments { uvec2 items; };
void main() { Items(items).at[gl_GlobalInvocationID.x].color = vec4(1); }
END
in_room glslangValidator --quiet --target-env vulkan1.2 -o scalar.spv scalar.comp

result() { # spirv-opt, options...
    if in_room "$1" -O "${@:2}" scalar.spv -o /dev/null >/dev/null 2>&1; then echo taken; else echo refused; fi
}
old=/opt/spirv-tools/$older/usr/bin/spirv-opt
new=/usr/bin/spirv-opt
for tool in "$old" "$new"; do in_room "$tool" --version | head -n 1; done
same "2025.1, universal" "$(result "$old")" refused
same "2026.4, universal" "$(result "$new")" taken
same "2025.1, vulkan1.2" "$(result "$old" --target-env=vulkan1.2)" refused
same "2026.4, vulkan1.2" "$(result "$new" --target-env=vulkan1.2)" refused
same "2025.1, universal, --scalar-block-layout" "$(result "$old" --scalar-block-layout)" taken
same "2026.4, vulkan1.2, --scalar-block-layout" "$(result "$new" --target-env=vulkan1.2 --scalar-block-layout)" taken
same "2025.1, --skip-validation" "$(result "$old" --skip-validation)" taken
conclude
