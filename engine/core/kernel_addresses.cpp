// SPDX-License-Identifier: MIT
#include "engine/core/kernel_addresses.h"

#include <cstring>
#include <map>

#include "engine/core/context.h"
#include "engine/core/error.h"
#include "engine/core/platform.h"
#include "engine/core/spirv_words.h"

namespace twinray {
namespace {

using spirv::Op, spirv::Words;
using spirv::op_of, spirv::words_of;

struct Member {
    std::string name;
    std::uint32_t type = 0, offset = 0;
};

// The declarations of a module, which precede its functions.
class Declarations {
  public:
    explicit Declarations(Words module) {
        for (std::size_t at = spirv::header_words, words = 0; at < module.size(); at += words) {
            words = words_of(module[at]);
            if (op_of(module[at]) == Op::Function || words == 0 || words > module.size() - at) return;
            take(module.subspan(at, words));
        }
    }
    std::vector<KernelAddress> addresses() const {
        std::vector<KernelAddress> found;
        if (pushed_ != 0) collect(pushed_, "", 0, found);
        return found;
    }

  private:
    void take(Words words) {
        using enum Op;
        switch (op_of(words[0])) {
            case MemberName:
                structs_[words[1]][words[2]].name = reinterpret_cast<const char*>(words.data() + 3);
                return;
            case MemberDecorate:
                if (words[3] == spirv::decoration_offset) structs_[words[1]][words[2]].offset = words[4];
                return;
            case TypeStruct:
                for (std::uint32_t i = 2; i < words.size(); ++i) structs_[words[1]][i - 2].type = words[i];
                return;
            case TypePointer: pointees_[words[1]] = words[3]; return;
            case Variable:
                if (words[3] == spirv::storage_push_constant) pushed_ = pointees_[words[1]];
                return;
            default: return;
        }
    }

    // Such structs are declared by REFERENCE of twinray/glsl/common.glsl.
    static bool is_ref(const std::map<std::uint32_t, Member>& members) {
        return members.size() == 1 && members.begin()->second.name == "address";
    }
    void collect(std::uint32_t type, const std::string& name, std::uint32_t offset,
                 std::vector<KernelAddress>& found) const {
        const auto members = structs_.find(type);
        if (members == structs_.end()) return;
        if (is_ref(members->second)) return found.push_back({name, offset});
        for (const auto& [index, member] : members->second)
            collect(member.type, name.empty() ? member.name : name + "." + member.name, offset + member.offset, found);
    }

    std::map<std::uint32_t, std::map<std::uint32_t, Member>> structs_;  // by id, by index
    std::map<std::uint32_t, std::uint32_t> pointees_;
    std::uint32_t pushed_ = 0;
};

}  // namespace

std::vector<KernelAddress> kernel_addresses(std::span<const std::uint32_t> spirv) {
    return Declarations(spirv).addresses();
}

std::vector<std::byte> readable_args(Context& context, const std::string& kernel,
                                     std::span<const KernelAddress> addresses, std::span<const std::byte> args) {
    std::vector<std::byte> readable(args.begin(), args.end());
    const std::uint64_t absent = context.absent();
    const bool is_checked = context.state().is_validating() && context.properties().kind == DeviceKind::cpu;
    for (const KernelAddress& member : addresses) {
        if (member.offset + sizeof(std::uint64_t) > readable.size())
            fail("kernel '", kernel, "': its arguments have ", readable.size(), " bytes, and the module reads '",
                 member.name, "' at ", member.offset);
        std::byte* const at = readable.data() + member.offset;
        std::uint64_t address = 0;
        std::memcpy(&address, at, sizeof(address));
        if (address == 0) address = absent;
        std::memcpy(at, &address, sizeof(address));
        if (is_checked && !platform::is_mapped(address))
            context.state().add_validation_message(
                text("kernel '", kernel, "': nothing can be read at '", member.name, "', address ", address));
    }
    return readable;
}

}  // namespace twinray
