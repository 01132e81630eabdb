// SPDX-License-Identifier: MIT
#include "engine/scene/bytes.h"
#include "tests/fuzz/contract.h"

namespace twinray::fuzz {

void encodings(Input input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    is_taken([&] { unpack_gzip(Bytes(input.begin(), input.end()), "input"); });
    if (const std::optional<Bytes> bytes = decode_base64(text))
        require(bytes->size() <= text.size() / 4 * 3 + 3, "four characters are three bytes");
    require(decode_percent(text).size() <= text.size(), "escapes are longer than what they stand for");
}

}  // namespace twinray::fuzz
