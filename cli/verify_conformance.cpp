// SPDX-License-Identifier: MIT
#include "cli/verify_conformance.h"

#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/case_choice.h"
#include "engine/core/error.h"
#include "twinray_version.h"
#include "validation/conformance/output.h"

namespace twinray::cli {

int verify_conformance(const CommonOptions& options, const std::vector<std::string>& only, bool is_full) {
    std::vector<std::string> ids;
    for (const conformance::Case& row : conformance::catalogue()) ids.push_back(row.id);
    check_choice(only, ids, "docs/conformance.md");
    Context context(watched_context_desc(options, most_conformance_seconds));
    Recorder recorder({utc_now(), twinray_version, probed_device(context)});
    std::cout << "conformance, " << (is_full ? "full" : "quick") << ", on " << context.properties().name << ", "
              << context.properties().driver << '\n';
    conformance::run(context,
                     {.is_full = is_full,
                      .seed = options.seed,
                      .is_wanted = [&](const conformance::Case& row) { return is_chosen(only, row.id); }},
                     recorder, options.quiet,
                     [&](const Record& record) { append_json(options.json, nlohmann::json::parse(to_json(record))); });
    conformance::print(std::cout, recorder.records());
    if (conformance::has_fault_of_ours(recorder.records())) return 1;
    return options.strict && conformance::fails_demands(recorder.records()) ? 1 : 0;
}

}  // namespace twinray::cli
