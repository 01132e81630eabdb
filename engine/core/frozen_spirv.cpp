#include "engine/core/spirv_words.h"

#include <map>
#include <set>

namespace twinray {
namespace {

using spirv::evaluate, spirv::op_of, spirv::words_of, spirv::first_word;
using spirv::Op, spirv::Words;

class Freezer {
  public:
    Freezer(Words module, std::span<const SpecializationConstant> constants) {
        for (const SpecializationConstant& constant : constants) given_[constant.id] = constant.value;
        frozen_.assign(module.begin(), module.begin() + spirv::header_words);
        for (std::size_t at = spirv::header_words; at < module.size(); at += words_of(module[at]))
            take(module.subspan(at, words_of(module[at])));
    }
    std::vector<std::uint32_t> frozen() && { return std::move(frozen_); }

  private:
    void take(Words instruction) {
        using enum Op;
        switch (op_of(instruction[0])) {
            case Decorate:
                if (instruction[2] != spirv::decoration_spec_id) return keep(instruction);
                spec_ids_[instruction[1]] = instruction[3];
                return;
            case TypeBool: booleans_.insert(instruction[1]); return keep(instruction);
            case TypeInt:
                if (instruction[2] == 32) numbers_.insert(instruction[1]);
                return keep(instruction);
            case ConstantTrue:
            case SpecConstantTrue: return define(instruction, value_or(instruction[2], 1));
            case ConstantFalse:
            case SpecConstantFalse: return define(instruction, value_or(instruction[2], 0));
            case Constant:
            case SpecConstant:
                if (instruction.size() != 4) return keep(instruction);  // of 64 bits
                return define(instruction, value_or(instruction[2], instruction[3]));
            case SpecConstantComposite:
                frozen_.push_back(first_word(ConstantComposite, instruction.size()));
                frozen_.insert(frozen_.end(), instruction.begin() + 1, instruction.end());
                return;
            case SpecConstantOp: return fold(instruction);
            default: return keep(instruction);
        }
    }

    void keep(Words instruction) { frozen_.insert(frozen_.end(), instruction.begin(), instruction.end()); }

    std::uint32_t value_or(std::uint32_t id, std::uint32_t standard) const {
        const auto spec_id = spec_ids_.find(id);
        if (spec_id == spec_ids_.end()) return standard;
        const auto given = given_.find(spec_id->second);
        return given == given_.end() ? standard : given->second;
    }

    // Defines a constant with the type and id of an instruction.
    void define(Words instruction, std::uint32_t value) {
        const std::uint32_t type = instruction[1], id = instruction[2];
        if (booleans_.contains(type) || numbers_.contains(type)) known_[id] = value;
        if (booleans_.contains(type))
            frozen_.insert(frozen_.end(), {first_word(value ? Op::ConstantTrue : Op::ConstantFalse, 3), type, id});
        else
            frozen_.insert(frozen_.end(), {first_word(Op::Constant, 4), type, id, value});
    }

    void fold(Words instruction) {
        std::uint32_t operands[3] = {};
        const Words ids = instruction.subspan(4);
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const auto found = known_.find(ids[i]);
            if (i >= 3 || found == known_.end()) return keep(instruction);
            operands[i] = found->second;
        }
        const std::optional<std::uint32_t> value =
            evaluate(static_cast<Op>(instruction[3]), operands[0], operands[1], operands[2]);
        if (value)
            define(instruction, *value);
        else
            keep(instruction);
    }

    std::map<std::uint32_t, std::uint32_t> given_;     // by SpecId
    std::map<std::uint32_t, std::uint32_t> spec_ids_;  // by result
    std::map<std::uint32_t, std::uint32_t> known_;     // values of the following types, by result
    std::set<std::uint32_t> booleans_, numbers_;       // types: of truth, of whole numbers of 32 bits
    std::vector<std::uint32_t> frozen_;
};

}  // namespace

std::vector<std::uint32_t> freeze_constants(std::span<const std::uint32_t> spirv,
                                            std::span<const SpecializationConstant> constants) {
    return Freezer(spirv, constants).frozen();
}

}  // namespace twinray
