// SPDX-License-Identifier: MIT
#include "report/page/summary.h"

#include <map>

#include "report/page/verdict.h"

namespace twinray::report {

void print_summary(std::ostream& out, std::span<const Record> records) {
    const Verdict verdict = verdict_of(records);
    out << verdict.headline << '\n';
    for (const Sentence& sentence : verdict.sentences) {
        const bool is_judged = sentence.kind == Sentence::Kind::wrong || sentence.kind == Sentence::Kind::right;
        out << "  " << (is_judged ? word_of(sentence.kind) : "     ") << "  " << sentence.about << ": " << sentence.text
            << '\n';
    }
    std::map<std::string, std::size_t> sums;
    for (const Record& record : records) {
        ++sums[result_of(record)];
        if (record.fault_of == "twinray")
            out << "  " << record.case_id << ' ' << record.backend << ' ' << record.level << ' ' << result_of(record)
                << ": " << record.faults << " of " << record.n << (record.reason.empty() ? "" : "; ") << record.reason
                << (record.example.empty() ? "" : "; ") << record.example << '\n';
    }
    out << "  ";
    const char* separator = "";
    for (const auto& [kind, count] : sums) {
        out << separator << kind << ' ' << count;
        separator = ", ";
    }
    out << '\n';
}

void print_other_lines(std::ostream& out, const JsonLines& baseline) {
    const char* separator = "  not compared: ";
    for (const auto& [kind, count] : baseline.others) {
        out << separator << count << " of " << kind;
        separator = ", ";
    }
    if (!baseline.others.empty()) out << '\n';
}

}  // namespace twinray::report
