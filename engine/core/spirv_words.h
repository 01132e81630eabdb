// The words of a SPIR-V module, with the numbers of its specification, and changes to a module for one pipeline.
#pragma once

#include <cstddef>

#include <twinray/commands.h>

namespace twinray::spirv {

using Words = std::span<const std::uint32_t>;

constexpr std::size_t header_words = 5;

enum class Op : std::uint32_t {
    Undef = 1,
    Name = 5,
    MemberName = 6,
    Line = 8,
    Extension = 10,
    ExtInstImport = 11,
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
    FunctionEnd = 56,
    FunctionCall = 57,
    Variable = 59,
    Decorate = 71,
    MemberDecorate = 72,
    GroupDecorate = 74,
    CompositeConstruct = 80,
    CompositeExtract = 81,
    LogicalOr = 166,
    LogicalAnd = 167,
    Select = 169,
    BitwiseAnd = 199,
    Phi = 245,
    LoopMerge = 246,
    SelectionMerge = 247,
    Label = 248,
    Branch = 249,
    BranchConditional = 250,
    Unreachable = 255,
    NoLine = 317,
    DecorateId = 332,
    TypeCooperativeMatrix = 4456,
    TypeRayQuery = 4472,
    TypeAccelerationStructure = 5341,
    DecorateString = 5632,
};
// Instructions between them have a type, a result and operands that are ids.
constexpr Op first_operation = static_cast<Op>(109), last_operation = static_cast<Op>(205);
constexpr std::uint32_t decoration_spec_id = 1, decoration_builtin = 11, decoration_offset = 35;
constexpr std::uint32_t storage_workgroup = 4, storage_push_constant = 9;

// Read and make the first word of an instruction.
constexpr Op op_of(std::uint32_t first) { return static_cast<Op>(first & 0xffffu); }
constexpr std::size_t words_of(std::uint32_t first) { return first >> 16; }
constexpr std::uint32_t first_word(Op op, std::size_t words) {
    return static_cast<std::uint32_t>(words) << 16 | static_cast<std::uint32_t>(op);
}

// Returns whether it defines a type, whose id is the first operand.
constexpr bool is_type(Op op) {
    using enum Op;
    return (op >= static_cast<Op>(19) && op <= static_cast<Op>(38)) || op == TypeCooperativeMatrix ||
           op == TypeRayQuery || op == TypeAccelerationStructure;
}
// Returns whether the next word is the id of the annotated object.
constexpr bool is_annotation(Op op) {
    using enum Op;
    return op == Name || op == Decorate || op == DecorateId || op == DecorateString;
}

// Returns the result of an operation on 32-bit whole numbers or booleans; nothing for one that GLSL does not make.
constexpr std::optional<std::uint32_t> evaluate(Op op, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto less = [](std::uint32_t x, std::uint32_t y) {
        return static_cast<std::int32_t>(x) < static_cast<std::int32_t>(y);
    };
    switch (static_cast<std::uint32_t>(op)) {
        case 128: return a + b;
        case 130: return a - b;
        case 132: return a * b;
        case 134: return b == 0 ? std::nullopt : std::optional(a / b);
        case 137: return b == 0 ? std::nullopt : std::optional(a % b);
        case 164:
        case 170: return a == b;  // of booleans, of numbers
        case 165:
        case 171: return a != b;
        case 166: return a | b;
        case 167: return a & b;
        case 168: return !a;
        case 169: return a ? b : c;
        case 172: return a > b;
        case 173: return less(b, a);
        case 174: return a >= b;
        case 175: return !less(a, b);
        case 176: return a < b;
        case 177: return less(a, b);
        case 178: return a <= b;
        case 179: return !less(b, a);
        case 194: return a >> (b & 31);
        case 196: return a << (b & 31);
        case 197: return a | b;
        case 198: return a ^ b;
        case 199: return a & b;
        case 200: return ~a;
        default: return std::nullopt;
    }
}

// Returns whether instructions fill it, one after the other.
constexpr bool is_module(Words words) {
    if (words.size() < header_words || words[0] != 0x07230203 || words[3] > 0x3fffff) return false;
    std::size_t at = header_words;
    while (at < words.size() && words_of(words[at]) != 0) at += words_of(words[at]);
    return at == words.size();
}

}  // namespace twinray::spirv

namespace twinray {

// Returns the module with these values, and its own defaults, in place of its specialisation constants and of
// expressions that depend only on them.
std::vector<std::uint32_t> freeze_constants(std::span<const std::uint32_t> spirv,
                                            std::span<const SpecializationConstant> constants);

// Returns the module without the blocks that no invocation can reach, by conditions that are constants, and without
// functions that are then not called. A module with debug information that names code is returned unchanged.
std::vector<std::uint32_t> prune_branches(std::span<const std::uint32_t> spirv);

}  // namespace twinray
