#include "validation/records/record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/core/error.h"
#include "validation/records/recorder.h"
#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

Record full_record() {
    Record record;
    record.run = "2026-01-02T03:04:05Z";
    record.git = "0.1.0 abc";
    record.device = {
        "llvm \"pipe\"", "Mesa, 25", "1.4.305", {{"fma_fused", false}, {"div_ulp", 0.5}, {"denorm", "kept"}}};
    record.case_id = "W04";
    record.params = {{"aim", "vertex, \"edge\"\nline"}, {"cells", 4608}, {"closed", true}};
    record.backend = "sw";
    record.level = "watertight";
    record.variant = "control";
    record.reference = "f64";
    record.n = 262144;
    record.seed = 18446744073709551615u;
    record.counts = {{"AGREE", 262143}, {"SW_LEAK", 1}};
    record.results = {{"sah_ratio", 1.25}};
    record.error = ErrorFigures{"t_ulp", 0.25, 3.1, {2.9, 3.3}, 1e300, 0.5};
    record.faults = 1;
    record.bound95 = 1.8e-5;
    record.time = TimeFigures{"ns_per_ray", 410.1, {400, 420}, 3.5, 399.9, 15, {{"build", 12.5}, {"copy", 0.1}}};
    record.pass = false;
    record.criterion = "SW_LEAK == 0";
    record.fault_of = "twinray";
    record.reason = "a, reason";
    record.example = "SW_LEAK 0x1p+0";
    record.replay = "replays/W04.json";
    return record;
}

TEST(Record, ComesBackFromJson) {
    EXPECT_EQ(record_of_json(to_json(full_record())), full_record());
    EXPECT_EQ(to_json(full_record()).find('\n'), std::string::npos) << "it is one line";
    Record bare;
    bare.case_id = "N01";
    bare.was_run = false;
    EXPECT_EQ(record_of_json(to_json(bare)), bare);
}

TEST(Record, KeepsNumbersThatAreNotFinite) {
    Record record;
    record.error = ErrorFigures{"relative", 0, INFINITY, {-INFINITY, INFINITY}, std::nan(""), 0};
    const Record back = record_of_json(to_json(record));
    EXPECT_EQ(back.error->p99, INFINITY);
    EXPECT_EQ(back.error->p99_95, (Interval{-INFINITY, INFINITY}));
    EXPECT_TRUE(std::isnan(back.error->max));
}

TEST(Record, RefusesWhatIsNone) {
    EXPECT_THROW(record_of_json("{"), Error);
    EXPECT_THROW(record_of_json("{}"), Error);
    std::string other = to_json(full_record());
    other.replace(other.find("report/1"), 8, "report/9");
    test::expect_error("twinray-report/9", [&] { record_of_json(other); });
}

TEST(Record, JsonNestedAMillionDeepIsRefused) {
    const std::string deep = "{\"schema\":" + std::string(1'000'000, '[') + std::string(1'000'000, ']') + "}";
    test::expect_error("nested deeper than 100 levels", [&] { record_of_json(deep); });
    test::expect_error("nested deeper than 100 levels", [&] { kind_of_json(deep); });
}

TEST(Value, TextShowsIntegersAsIntegers) {
    const std::pair<Value, const char*> texts[] = {
        {3, "3"}, {0.5, "0.5"}, {-1e20, "-1e+20"}, {true, "true"}, {"kept", "kept"}};
    for (const auto& [value, text] : texts) EXPECT_EQ(value.text(), text);
}

// A reader of RFC 4180.
std::vector<std::vector<std::string>> csv_rows(const std::string& text) {
    std::vector<std::vector<std::string>> rows(1, {""});
    bool is_quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        std::string& cell = rows.back().back();
        if (is_quoted && text[i] == '"' && i + 1 < text.size() && text[i + 1] == '"') {
            cell += '"', ++i;
        } else if (text[i] == '"') {
            is_quoted = !is_quoted;
        } else if (!is_quoted && text[i] == ',') {
            rows.back().emplace_back();
        } else if (!is_quoted && text.compare(i, 2, "\r\n") == 0) {
            rows.push_back({""}), ++i;
        } else {
            cell += text[i];
        }
    }
    rows.pop_back();
    return rows;
}

class RecorderTest : public ::testing::Test {
  protected:
    test::TempDir folder_;
    std::filesystem::path file_ = folder_ / "report.jsonl";
};

TEST_F(RecorderTest, FillsInTheRunAndWritesEachRecordAtOnce) {
    Recorder recorder({"now", "0.1.0", {"device", "driver", "1.2", {{"fp64", true}}}}, file_);
    Record record;
    record.case_id = "W01";
    recorder.add(record);
    const std::vector<Record> first = read_json_lines(file_).records;
    ASSERT_EQ(first.size(), 1u);
    EXPECT_EQ(first[0].run, "now");
    EXPECT_EQ(first[0].device.probe.at("fp64"), Value(true));
    recorder.add(full_record());
    EXPECT_EQ(read_json_lines(file_).records, recorder.records());
    EXPECT_EQ(recorder.records()[1].git, "0.1.0");
}

TEST_F(RecorderTest, ReadingNamesTheLine) {
    const std::string record = to_json(full_record());
    for (const std::string& broken :
         {std::string("{\"schema\": "), std::string("[]"), std::string("7"), record.substr(0, record.size() / 2),
          std::string("{\"schema\": \"twinray-report/1\", \"run\": \"now\"}")}) {
        std::ofstream(file_) << record << '\n' << broken << '\n';
        test::expect_error(file_.string() + "' line 2: ", [&] { read_json_lines(file_); });
    }
    EXPECT_THROW(read_json_lines(folder_ / "none.jsonl"), Error);
    EXPECT_THROW(Recorder({"", "", {}}, folder_ / "none" / "report.jsonl"), Error);
}

// Lines are as `twinray trace`, `twinray verify` and the samples append them.
TEST_F(RecorderTest, LinesOfOtherCommandsAreCounted) {
    std::ofstream(file_) << to_json(full_record()) << "\n\n"
                         << R"({"schema": "twinray-trace/1", "n": 3})" << '\n'
                         << R"({"schema": "twinray-trace/1", "n": 4})" << '\n'
                         << R"({"schema": "twinray-report/1", "case": "verify.random", "device": {"name": "x"}})"
                         << '\n'
                         << R"({"schema": "twinray-report/1", "case": "path_tracer", "device": "x"})" << '\n'
                         << R"({"frames": 4})" << '\n';
    const JsonLines lines = read_json_lines(file_);
    EXPECT_EQ(lines.records, std::vector<Record>{full_record()});
    EXPECT_EQ(lines.others, (std::map<std::string, std::size_t>{
                                {"no schema", 1}, {"path_tracer", 1}, {"twinray-trace/1", 2}, {"verify.random", 1}}));
}

// Each cell has the value of the JSON line, under one header for all.
TEST_F(RecorderTest, TableHoldsWhatTheLinesHold) {
    Record other;
    other.case_id = "N01";
    other.counts = {{"HW_LEAK", 7}};
    other.params = {{"other", 1}};
    const std::vector<Record> records = {full_record(), other};
    write_csv(file_, records);
    std::ifstream in(file_);
    std::stringstream text;
    text << in.rdbuf();
    const auto rows = csv_rows(text.str());
    ASSERT_EQ(rows.size(), 3u);
    for (std::size_t i = 0; i < records.size(); ++i) {
        ASSERT_EQ(rows[i + 1].size(), rows[0].size());
        const auto json = nlohmann::json::parse(to_json(records[i]));
        for (std::size_t column = 0; column < rows[0].size(); ++column) {
            std::string pointer = "/" + rows[0][column];
            for (char& c : pointer) c = c == '.' ? '/' : c;
            const nlohmann::json value = json.value(nlohmann::json::json_pointer(pointer), nlohmann::json());
            const std::string cell = value.is_null() ? "" : value.is_string() ? value.get<std::string>() : value.dump();
            EXPECT_EQ(rows[i + 1][column], cell) << rows[0][column];
        }
    }
    const auto has = [&](const char* name) { return std::count(rows[0].begin(), rows[0].end(), name) == 1; };
    EXPECT_TRUE(has("counts.SW_LEAK") && has("counts.HW_LEAK") && has("device.probe.div_ulp") && has("time.build_ms"));
}

}  // namespace
}  // namespace twinray
