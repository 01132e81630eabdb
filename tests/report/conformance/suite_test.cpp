// The suite on a device: cases that pass, cases known to fail, and that every case can fail.
#include "report/conformance/suite.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "engine/core/device_properties.h"
#include "engine/core/error.h"
#include "tests/support/device.h"
#include "report/faults/fault_injection.h"
#include "report/conformance/driver.h"

namespace twinray::conformance {
namespace {

using Ids = std::set<std::string>;

// docs/conformance.md lists the same, and says what happens.
struct KnownFaults {
    Ids must, should;
    Ids end_the_process;  // ctest conformance.command runs these, each in a process of its own
};

const KnownFaults& known_faults(const DeviceProperties& lavapipe) {
    static const KnownFaults before_26 = {{"K07", "K12", "K31"}, {"K33", "K79", "K80", "K81", "K82"}, {}};
    static const KnownFaults since_26 = {{"K05", "K07", "K31"}, {"K33"}, {"K04", "K08", "K35", "K36", "K37"}};
    return lavapipe_release(lavapipe) >= 26 ? since_26 : before_26;
}

class ConformanceSuite : public test::VulkanTest {
  protected:
    std::vector<Record> run(const Settings& settings = {}) {
        Recorder recorder({"now", "0.1", {}});
        conformance::run(context(), settings, recorder, true);
        return recorder.records();
    }
};

using frame::is_control;

template <class IsWanted>
std::vector<std::string> ids_of(const IsWanted& is_wanted) {
    std::vector<std::string> ids;
    for (const Case& row : catalogue())
        if (is_wanted(row)) ids.push_back(row.id);
    return ids;
}

std::vector<std::string> of_topic(Topic topic) {
    return ids_of([&](const Case& row) { return row.topic == topic; });
}

Ids failed(const std::vector<Record>& records, const char* demand) {
    Ids ids;
    for (const Record& record : records)
        if (record.fault_of == "driver" && record.results.at("demand") == Value(demand)) ids.insert(record.case_id);
    return ids;
}

TEST_F(ConformanceSuite, KnowsWhatPassesAndEveryControlShowsFaults) {
    if (!missing_for_hardware(context().properties()).empty()) TWINRAY_LACKS("ray_tracing", "no structures to ask");
    const KnownFaults& known = known_faults(context().properties());
    const std::vector<Record> records =
        run({.only = ids_of([&](const Case& row) { return !known.end_the_process.contains(row.id); })});
    std::size_t cases = 0, controls = 0;
    for (const Record& record : records) {
        if (!record.was_run) continue;
        ++(is_control(record) ? controls : cases);
        EXPECT_GT(record.n, 0u) << record.case_id;
        EXPECT_NE(record.fault_of, "twinray") << record.case_id << ' ' << record.variant << ": " << record.reason;
        EXPECT_TRUE(!is_control(record) || record.faults > 0) << record.case_id << ' ' << record.variant;
        EXPECT_EQ(record_of_json(to_json(record)), record);
    }
    EXPECT_EQ(controls, cases);
    if (context().properties().driver_id != VK_DRIVER_ID_MESA_LLVMPIPE) return;
    const auto not_run =
        std::ranges::count_if(catalogue(), [](const Case& row) { return !row.not_by_pipeline.empty(); });
    EXPECT_EQ(cases + static_cast<std::size_t>(not_run), 2 * (catalogue().size() - known.end_the_process.size()));
    EXPECT_TRUE(std::ranges::includes(known.must, failed(records, "must")));
    EXPECT_TRUE(std::ranges::includes(known.should, failed(records, "should")));
    EXPECT_EQ(fails_demands(records), !failed(records, "must").empty());
    EXPECT_FALSE(has_fault_of_ours(records));
    std::ostringstream text;
    print(text, records);
    for (const std::string& id : failed(records, "must"))
        EXPECT_NE(text.str().find(id + " hw must "), std::string::npos) << text.str();
}

TEST_F(ConformanceSuite, TellsTheFirstFaultyRay) {
    if (!context().properties().ray_query) return;
    for (const Record& record : run({.only = of_topic(Topic::edges)})) {
        EXPECT_EQ(record.results.at("topic"), Value("edges"));
        if (record.faults == 0) continue;
        const std::string kind = record.example.substr(0, record.example.find(' '));
        EXPECT_TRUE(record.counts.contains(kind)) << record.example;
        EXPECT_EQ(std::ranges::count(record.example, ' '), 8) << "eight floats: " << record.example;
    }
}

// Under full, the same cases take more rays, in larger rounds.
TEST_F(ConformanceSuite, FullSharesItsRaysOutToTheCases) {
    if (!context().properties().ray_query) return;
    for (const Record& record : run({.is_full = true, .full_rays = 9'600'000, .only = of_topic(Topic::limits)})) {
        if (is_control(record)) continue;
        EXPECT_GT(record.n, 10'000u) << record.case_id;
        EXPECT_LE(record.n, 100'000u) << record.case_id;
        EXPECT_EQ(record.pass, true) << record.case_id << ' ' << record.reason << ' ' << record.example;
    }
}

// The device never ends the work that the fifth case submits.
TEST(ConformanceOfAHungDevice, TellsTheCaseAndEnds) {
    faults::FaultInjector driver;
    const std::unique_ptr<Context> context =
        test::make_context({.most_wait_seconds = 60, .get_instance_proc_addr = driver.entry()});
    if (!context) return;
    const DeviceProperties& device = context->properties();
    if (!device.ray_query || !device.ray_tracing_pipeline) TWINRAY_LACKS("ray_tracing", "no ray tracing");
    Recorder recorder({"now", "0.1", {}});
    std::string hung;
    conformance::run(*context, {}, recorder, true, [&](const Record& record) {
        if (recorder.records().size() == 8) driver.inject({"vkWaitSemaphores", 1, faults::every_call, VK_TIMEOUT});
        if (record.fault_of == "driver" && recorder.records().size() == 9) hung = record.reason;
    });
    EXPECT_NE(hung.find("it has ended none of its submissions for 60 s"), std::string::npos) << hung;
    for (const Record& record : std::span(recorder.records()).subspan(9)) {
        EXPECT_FALSE(record.was_run);
        EXPECT_EQ(record.reason, "the device was lost in K03");
    }
    driver.heal();
}

class ConformanceWithoutQueries : public ConformanceSuite {
  protected:
    ContextDesc context_desc() const override { return {.use_ray_query = false}; }
};

TEST_F(ConformanceWithoutQueries, ThePipelineAnswersAlone) {
    if (!context().properties().ray_tracing_pipeline) TWINRAY_LACKS("ray_tracing", "no pipelines");
    for (const Record& record : run({.only = of_topic(Topic::limits)})) {
        EXPECT_EQ(record.was_run, record.backend == "hw-pipeline");
        EXPECT_EQ(record.pass.has_value(), record.was_run);
        EXPECT_TRUE(record.was_run || record.reason.find("ray queries") != std::string::npos) << record.reason;
    }
    EXPECT_THROW(Driver driver(context()), Error);
}

class ConformanceWithoutHardware : public ConformanceSuite {
  protected:
    ContextDesc context_desc() const override { return {.use_ray_query = false, .use_ray_tracing_pipeline = false}; }
};

TEST_F(ConformanceWithoutHardware, NothingIsRunAndEachSaysWhy) {
    const std::vector<Record> records = run();
    EXPECT_EQ(records.size(), 2 * catalogue().size());
    for (const Record& record : records) {
        EXPECT_FALSE(record.was_run || record.pass.has_value());
        EXPECT_NE(record.reason.find("needs ray "), std::string::npos) << record.reason;
    }
}

}  // namespace
}  // namespace twinray::conformance
