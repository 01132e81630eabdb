// SPDX-License-Identifier: MIT
// Reports beside each other, as text.
#pragma once

#include <filesystem>
#include <ostream>

#include "report/page/compare.h"

namespace twinray::report {

struct NamedReport {
    std::string name;
    std::vector<Record> records;
};
// A file of JSON lines, or a folder with report.jsonl in it. Throws Error naming what cannot be read or has no record.
NamedReport read_report(const std::filesystem::path& path);

// Device, driver and version of each, and a table in Markdown: how often each was wrong in which way, which cases of
// the driver's own structures it fails, and how its time compares with SwTlas's.
void print_side_by_side(std::ostream& out, std::span<const NamedReport> reports);
// What changed, how times did, and a verdict with its chance to be a false alarm.
void print_comparison(std::ostream& out, const Comparison& comparison);

}  // namespace twinray::report
