// Both accelerators on one scene, compared with the reference, a set of rays at a time; the result as text and records.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

#include <twinray/tlas.h>
#include "validation/reference/classify.h"

namespace twinray {

struct RaySet {
    std::string name;  // "random", "vertex", "edge", "file"
    std::vector<Ray> rays;
};
// Makes random rays, and rays aimed at vertices and at edges.
std::vector<RaySet> test_rays(const ReferenceScene& reference, const Bounds& bounds, std::size_t random,
                              std::size_t aimed, std::uint64_t seed);

// An answer that is a fault of twinray or of the driver.
struct Fault {
    Ray ray;
    Hit answer;
    HitClass kind;
    bool is_of_software;
};

// The results of one set of rays.
struct Comparison {
    HitClassCounts software, hardware;
    std::map<std::pair<HitClass, HitClass>, std::uint64_t> disagreements;  // by (software, hardware), where hits differ
    std::vector<Fault> faults;  // the first ones of each class, see max_faults_of_ours and max_faults_of_driver
    double software_seconds = 0, hardware_seconds = 0;

    std::uint64_t disagreeing() const;
};

inline constexpr std::size_t max_faults_of_ours = 10'000, max_faults_of_driver = 100;

class Verifier {
  public:
    // Calls `fill` to fill both accelerators with the reference's scene, or SwTlas alone where the device lacks what
    // HwTlas needs at the level, and compiles their kernels, so that only tracing is timed.
    using Fill = std::function<void(AbstractAccel&)>;
    Verifier(Context& context, ReferenceScene reference, const Fill& fill, Level level);

    const ReferenceScene& reference() const { return reference_; }
    const HwTlas* hardware() const { return hardware_.get(); }               // null: see why_no_hardware()
    const std::string& why_no_hardware() const { return why_no_hardware_; }  // "" where there is one

    // Traces the closest hits of all rays by both and classifies each. `arbiter`: see Arbiter.
    Comparison compare(std::span<const Ray> rays, const Arbiter& arbiter,
                       const std::function<void(std::size_t)>& progress);

  private:
    void compare_batch(std::span<const Ray> rays, const Arbiter& arbiter, Comparison& comparison);

    Level level_;
    ReferenceScene reference_;
    std::string why_no_hardware_;
    SwTlas software_;
    std::unique_ptr<HwTlas> hardware_;
};

void print(std::ostream& out, const RaySet& set, const Comparison& comparison, bool has_hardware);

// Returns a record for each accelerator, added to the fields of `base`. `hardware` may be null.
std::vector<nlohmann::json> records_of(const nlohmann::json& base, const RaySet& set, const Comparison& comparison,
                                       const HwTlas* hardware);

}  // namespace twinray
