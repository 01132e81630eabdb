#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: glslang's output is valid SPIR-V, so a module that Debian 13's glslang makes passes any later
# spirv-val.
# Seen: a struct with an array member that is read through a function that returns a buffer reference makes glslang
# 15.2 give the local copy the array type of the buffer, with its layout (ArrayStride). spirv-val 2026.4 refuses the
# module: VUID-StandaloneSpirv-None-10684. That of glslang 16.6 passes. Three vec4 in place of vec4[3], which are the
# same bytes, pass from both; so does the array without the function.
# Seen with glslang-tools 15.1.0+1.4.309.0-1 (it calls itself 15.2.0), 16.6.0-1 and spirv-tools 2026.4~rc2-1 on
# 2026-11-27.
folder=$(mktemp -d)
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_room sid
install glslang-tools=16.6.0-1 spirv-tools=2026.4~rc2-1
older=15.1.0+1.4.309.0-1
unpack trixie glslang-tools "$older"

shader() { # file, member, how it is read
    cat >"$probe/$1.comp" <<END
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 1) in;
struct Item { $2; };
layout(buffer_reference, scalar) buffer Items { Item at[]; };
layout(push_constant) uniform Arguments { uvec2 items; uvec2 answer; };
Items items_at(uvec2 address) { return Items(address); }
layout(buffer_reference, scalar) buffer Answer { Item item; };
void main()
{
    const Item item = $3.at[gl_GlobalInvocationID.x];
    Answer(answer).item = item;
}
END
}
shader array 'vec4 rows[3]' 'items_at(items)'
shader vectors 'vec4 row0, row1, row2' 'items_at(items)'
shader direct 'vec4 rows[3]' 'Items(items)'

result() { # glslangValidator, shader: "valid" or the rule that it breaks
    local said
    in_room "$1" --quiet --target-env vulkan1.2 -o "$2.spv" "$2.comp"
    if said=$(in_room spirv-val --target-env vulkan1.2 --scalar-block-layout "$2.spv" 2>&1); then echo valid; else
        grep -o 'VUID-[A-Za-z]*-[A-Za-z]*-[0-9]*' <<<"$said" || echo "$said"
    fi
}
old=/opt/glslang-tools/$older/usr/bin/glslangValidator
new=/usr/bin/glslangValidator
in_room spirv-val --version | head -n 1
for validator in "$old" "$new"; do in_room "$validator" --version | sed -n 's/^Glslang Version: /glslang /p'; done
same "glslang $older, array through a function" "$(result "$old" array)" VUID-StandaloneSpirv-None-10684
same "glslang 16.6.0-1, array through a function" "$(result "$new" array)" valid
same "glslang $older, three vec4 through a function" "$(result "$old" vectors)" valid
same "glslang 16.6.0-1, three vec4 through a function" "$(result "$new" vectors)" valid
same "glslang $older, array without the function" "$(result "$old" direct)" valid
conclude
