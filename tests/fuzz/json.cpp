// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "tests/fuzz/contract.h"
#include "cli/kernels/limits.h"
#include "validation/leaks/leak_state.h"
#include "validation/records/recorder.h"
#include "report/replay/replay.h"

namespace twinray::fuzz {

void json(Input input) {
    const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
    const std::filesystem::path file = file_of(input, "input.json");
    is_taken([&] {
        const Record record = record_of_json(text);
        require(record_of_json(to_json(record)).case_id == record.case_id, "a record comes back as it was written");
    });
    is_taken([&] { read_json_lines(file); });
    is_taken([&] { replay::read(file); });
    is_taken([&] { read_state(file, {{"schema", "twinray-leaks/1"}, {"seed", 1}}); });
    is_taken([&] { kernels::read_rows(file); });
}

}  // namespace twinray::fuzz
