// SPDX-License-Identifier: MIT
// The words of a SPIR-V module, with the numbers of its specification.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace twinray::spirv {

using Words = std::span<const std::uint32_t>;

constexpr std::size_t header_words = 5;

enum class Op : std::uint32_t {
    Name = 5,
    MemberName = 6,
    Extension = 10,
    EntryPoint = 15,
    ExecutionMode = 16,
    Capability = 17,
    TypeBool = 20,
    TypeInt = 21,
    TypeFloat = 22,
    TypeVector = 23,
    TypeMatrix = 24,
    TypeArray = 28,
    TypeStruct = 30,
    TypePointer = 32,
    ConstantTrue = 41,
    ConstantFalse = 42,
    Constant = 43,
    ConstantComposite = 44,
    SpecConstantTrue = 48,
    SpecConstantFalse = 49,
    SpecConstant = 50,
    SpecConstantComposite = 51,
    SpecConstantOp = 52,
    Function = 54,
    Variable = 59,
    Decorate = 71,
    MemberDecorate = 72,
};
constexpr std::uint32_t decoration_spec_id = 1, decoration_builtin = 11, decoration_offset = 35;
constexpr std::uint32_t storage_workgroup = 4, storage_push_constant = 9;

// These read and make the first word of an instruction.
constexpr Op op_of(std::uint32_t first) { return static_cast<Op>(first & 0xffffu); }
constexpr std::size_t words_of(std::uint32_t first) { return first >> 16; }
constexpr std::uint32_t first_word(Op op, std::size_t words) {
    return static_cast<std::uint32_t>(words) << 16 | static_cast<std::uint32_t>(op);
}

}  // namespace twinray::spirv
