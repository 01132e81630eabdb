// SPDX-License-Identifier: MIT
// Every way of tracing of HwTlas as a parameter of tests.
#pragma once

#include <cstring>

#include <twinray/tlas.h>
#include "engine/core/ray.h"
#include "tests/support/device.h"

namespace twinray::test {

struct Way {
    const char* name;
    bool use_ray_query;
    BuildOrder order;

    friend void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }
};

// A fresh accelerator per test and way; skips the ways that the device does not have.
class HwTlasTest : public VulkanTest, public ::testing::WithParamInterface<Way> {
  protected:
    void SetUp() override {
        VulkanTest::SetUp();
        if (IsSkipped()) return;
        if (HasFailure()) FAIL() << "no device";
        const DeviceProperties& properties = context().properties();
        const bool has_way = GetParam().use_ray_query ? properties.ray_query : properties.ray_tracing_pipeline;
        if (!has_way || !missing_for_hardware(properties).empty())
            TWINRAY_LACKS("ray_tracing", properties.name + " has no such ray tracing");
        accel_ = std::make_unique<HwTlas>(context(), GetParam().order);
    }
    void TearDown() override {
        accel_.reset();
        VulkanTest::TearDown();
    }
    ContextDesc context_desc() const override { return {.use_ray_query = GetParam().use_ray_query}; }
    HwTlas& accel() { return *accel_; }

  private:
    std::unique_ptr<HwTlas> accel_;
};

inline const auto all_ways = ::testing::Values(
    Way{"RayQueryInputOrder", true, BuildOrder::input}, Way{"RayQueryMortonOrder", true, BuildOrder::morton},
    Way{"PipelineInputOrder", false, BuildOrder::input}, Way{"PipelineMortonOrder", false, BuildOrder::morton});
inline const auto name_of_way = [](const auto& info) { return info.param.name; };

inline bool same_bytes(const Hit& a, const Hit& b) { return std::memcmp(&a, &b, sizeof(Hit)) == 0; }

}  // namespace twinray::test
