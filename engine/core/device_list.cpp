#include "engine/core/device_list.h"

#include <algorithm>

#include "engine/core/error.h"

namespace twinray {

void grow(Context& context, Buffer& buffer, const char* name, std::uint64_t bytes) {
    if (buffer.bytes() >= bytes) return;
    buffer = {};  // both at once might not fit
    buffer = Buffer(context, {.name = name, .bytes = bytes});
}

DeviceList::DeviceList(Context& context, const char* name, std::uint64_t element_bytes)
    : context_(context),
      name_(name),
      element_bytes_(element_bytes),
      total_(context, {.name = "total of a list", .bytes = sizeof(ListTotal)}),
      pace_(context) {}

void DeviceList::set_limit(std::uint64_t count) {
    if (count > 0xffffffffu) fail(name_, ": a limit of ", count, "; at most ", 0xffffffffu, " can be numbered");
    limit_ = count;
}

std::uint64_t DeviceList::fill(const Record& record, std::uint64_t items, std::uint64_t expected,
                               const std::string& action) {
    grow(context_, elements_, name_, std::min(limit_, expected) * element_bytes_);
    for (;;) {
        const std::uint64_t room = std::min(limit_, elements_.bytes() / element_bytes_);
        Commands commands(context_, name_);
        {
            const auto pass = commands.pass("start of a list");
            commands.write(total_, ListTotal{0, 0});
        }
        const View list{elements_.address(), total_.ref<ListTotal>(), static_cast<uint>(room)};
        pace_.record(commands, items,
                     [&](std::uint64_t first, std::uint64_t some) { record(commands, list, first, some); });
        pace_.finish(commands);
        const ListTotal total = download<ListTotal>(context_, total_, 1).front();
        const std::uint64_t count = std::uint64_t{total.high} << 32 | total.low;
        if (count <= room) return count;
        if (count > limit_)
            fail(action, ": ", count, " ", name_, "; at most ", limit_, " are allowed, of ", element_bytes_,
                 " bytes of device memory each");
        grow(context_, elements_, name_, count * element_bytes_);
    }
}

}  // namespace twinray
