// SPDX-License-Identifier: MIT
#include "tests/support/spirv_needs.h"

#include <algorithm>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/spirv_words.h"

namespace twinray {
namespace {

using spirv::Op, spirv::Words;
using spirv::op_of, spirv::words_of;
using Id = std::uint32_t;

constexpr std::uint32_t mode_local_size = 17, workgroup_size = 25;

class Reader {
  public:
    Reader(Words module, const std::map<std::uint32_t, std::uint32_t>& constants) : constants_(constants) {
        if (module.size() < spirv::header_words || module[0] != 0x07230203u) fail("no SPIR-V module");
        needs_.version = module[1];
        for (std::size_t at = spirv::header_words; at < module.size(); at += words_of(module[at]))
            take(module.subspan(at, words_of(module[at])));
        for (const Words& variable : variables_) add(variable);
        if (group_size_) needs_.group_invocations = product(group_size_);
    }
    SpirvNeeds needs() && { return std::move(needs_); }

  private:
    void take(Words words) {
        using enum Op;
        switch (op_of(words[0])) {
            case Capability: needs_.capabilities.insert(words[1]); return;
            case Extension: needs_.extensions.insert(reinterpret_cast<const char*>(&words[1])); return;
            case ExecutionMode:
                if (words[2] == mode_local_size)
                    needs_.group_invocations = std::uint64_t{words[3]} * words[4] * words[5];
                return;
            case Decorate:
                if (words[2] == spirv::decoration_spec_id) spec_ids_[words[1]] = words[3];
                if (words[2] == spirv::decoration_builtin && words[3] == workgroup_size) group_size_ = words[1];
                return;
            case MemberDecorate:
                if (words[3] == spirv::decoration_offset) offsets_[{words[1], words[2]}] = words[4];
                return;
            case TypeBool:
            case TypeInt:
            case TypeFloat:
            case TypeVector:
            case TypeMatrix:
            case TypeArray:
            case TypeStruct:
            case TypePointer: defined_[words[1]] = words; return;
            case Constant:
            case ConstantComposite:
            case SpecConstant:
            case SpecConstantComposite:
            case SpecConstantOp: defined_[words[2]] = words; return;
            case Variable: variables_.push_back(words); return;
            default: return;
        }
    }

    Words definition(Id id) const {
        const auto found = defined_.find(id);
        if (found == defined_.end()) fail("SPIR-V: id ", id, " is neither a type nor a constant that is known here");
        return found->second;
    }

    void add(Words variable) {
        if (variable[3] != spirv::storage_workgroup && variable[3] != spirv::storage_push_constant) return;
        const Id type = definition(variable[1])[3];
        if (variable[3] == spirv::storage_workgroup)
            needs_.shared_bytes += round_up(size_of(type), 16);
        else
            needs_.push_constant_bytes = std::max(needs_.push_constant_bytes, size_of(type));
    }

    static std::uint64_t round_up(std::uint64_t bytes, std::uint64_t to) { return (bytes + to - 1) / to * to; }

    // A struct with offsets is as large as they say; otherwise vectors of three are as large as those of four.
    std::uint64_t size_of(Id type) const {
        using enum Op;
        const Words words = definition(type);
        switch (op_of(words[0])) {
            case TypeBool: return 4;
            case TypeInt:
            case TypeFloat: return words[2] / 8;
            case TypeVector:
            case TypeMatrix: return words[3] * size_of(words[2]);
            case TypeArray: return value_of(words[3]) * stride_of(words[2]);
            case TypePointer: return 8;
            default: return size_of_struct(words);
        }
    }
    std::uint64_t stride_of(Id element) const {
        const std::uint64_t bytes = size_of(element);
        return bytes > 8 ? round_up(bytes, 16) : bytes;
    }
    std::uint64_t size_of_struct(Words words) const {
        std::uint64_t end = 0;
        for (std::uint32_t member = 0; member + 2 < words.size(); ++member) {
            const auto offset = offsets_.find({words[1], member});
            const Id type = words[member + 2];
            end = offset == offsets_.end() ? end + stride_of(type) : std::max(end, offset->second + size_of(type));
        }
        return end;
    }

    std::uint32_t value_of(Id id) const {
        using enum Op;
        const Words words = definition(id);
        switch (op_of(words[0])) {
            case Constant: return words[3];
            case SpecConstant: {
                const auto spec_id = spec_ids_.find(id);
                if (spec_id == spec_ids_.end() || !constants_.contains(spec_id->second)) return words[3];
                return constants_.at(spec_id->second);
            }
            case SpecConstantOp: return computed(words);
            default: fail("SPIR-V: id ", id, " is no number");
        }
    }
    std::uint32_t computed(Words words) const {
        switch (words[3]) {
            case 81: return value_of(definition(words[4])[3 + words[5]]);  // OpCompositeExtract
            case 128: return value_of(words[4]) + value_of(words[5]);
            case 132: return value_of(words[4]) * value_of(words[5]);
            case 134: return value_of(words[4]) / value_of(words[5]);
            case 196: return value_of(words[4]) << value_of(words[5]);
            default: fail("SPIR-V: a size depends on operation ", words[3]);
        }
    }
    std::uint64_t product(Id composite) const {
        const Words words = definition(composite);
        return std::uint64_t{value_of(words[3])} * value_of(words[4]) * value_of(words[5]);
    }

    const std::map<std::uint32_t, std::uint32_t>& constants_;
    SpirvNeeds needs_;
    Id group_size_ = 0;
    std::map<Id, std::uint32_t> spec_ids_;
    std::map<std::pair<Id, std::uint32_t>, std::uint32_t> offsets_;  // by struct and member
    std::map<Id, Words> defined_;                                    // types and constants
    std::vector<Words> variables_;
};

}  // namespace

SpirvNeeds needs_of(std::span<const std::uint32_t> spirv, const std::map<std::uint32_t, std::uint32_t>& constants) {
    return Reader(spirv, constants).needs();
}

}  // namespace twinray
