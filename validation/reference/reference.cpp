// The public interface of the other files in this folder.

#include <numeric>

#include "engine/core/error.h"
#include "engine/core/statistics.h"
#include "validation/reference/aimed_rays.h"
#include "validation/reference/classify.h"
#include "validation/reference/reference_accel.h"

namespace twinray {
namespace {

HitClass class_of(const RayResult& result, TracedBy by) {
    return by == TracedBy::software ? result.software.value() : result.hardware.value();
}

template <class Answer>
std::optional<Answer> answer_if(bool is_given, const Answer& answer) {
    return is_given ? std::optional(answer) : std::nullopt;
}

}  // namespace

Reference::Reference(const Scene& scene) : scene_(std::make_shared<const ReferenceScene>(ReferenceScene::of(scene))) {}

Reference::Reference(std::span<const MeshView> meshes, std::span<const ReferenceInstance> instances)
    : scene_(std::make_shared<const ReferenceScene>(meshes, instances)) {}

ReferenceHit Reference::closest_hit(const Ray& ray) const { return scene_->closest_hit(ray); }

bool Reference::any_hit(const Ray& ray) const { return scene_->any_hit(ray); }

HitClass Reference::classify(const Ray& ray, const Hit& hit, TracedBy by) const {
    const bool is_software = by == TracedBy::software;
    return class_of(twinray::classify(*scene_, ray, answer_if(is_software, hit), answer_if(!is_software, hit)), by);
}

std::vector<HitClass> Reference::classify(std::span<const Ray> rays, std::span<const Hit> hits, TracedBy by) const {
    if (hits.size() != rays.size()) fail("classify: ", hits.size(), " hits for ", rays.size(), " rays");
    const std::span<const Hit> none;
    const bool is_software = by == TracedBy::software;
    std::vector<HitClass> classes;
    for (const RayResult& result : classify_all(*scene_, rays, is_software ? hits : none, is_software ? none : hits))
        classes.push_back(class_of(result, by));
    return classes;
}

HitClass Reference::classify_any(const Ray& ray, bool is_hit, TracedBy by) const {
    const bool is_software = by == TracedBy::software;
    return class_of(
        twinray::classify_any(*scene_, ray, answer_if(is_software, is_hit), answer_if(!is_software, is_hit)), by);
}

std::unique_ptr<AbstractAccel> make_reference_accel(Context& context) {
    return std::make_unique<ReferenceAccel>(context);
}

std::vector<Ray> vertex_aimed_rays(const Reference& reference, std::size_t count, std::uint64_t seed) {
    return vertex_aimed_rays(reference.scene(), count, seed);
}

std::vector<Ray> edge_aimed_rays(const Reference& reference, std::size_t count, std::uint64_t seed) {
    return edge_aimed_rays(reference.scene(), count, seed);
}

std::string_view name_of(HitClass kind) {
    static constexpr std::array<std::string_view, hit_class_count> names = {
        "AGREE",    "TIE",   "BOUNDARY", "BOUNDARY_HW_MISS", "UNSPECIFIED", "INVALID_INPUT", "SW_LEAK",
        "SW_FALSE", "T_ERR", "HW_LEAK",  "HW_FALSE",         "HW_T_ERR",    "HW_RANGE"};
    return names[static_cast<std::size_t>(kind)];
}

bool is_fault_of_hardware(HitClass kind) {
    return kind == HitClass::hw_leak || kind == HitClass::hw_false || kind == HitClass::hw_t_err ||
           kind == HitClass::hw_range;
}

bool is_fault_of_ours(HitClass kind) {
    return kind == HitClass::sw_leak || kind == HitClass::sw_false || kind == HitClass::t_err;
}

HitClassCounts& HitClassCounts::operator+=(const HitClassCounts& other) {
    for (std::size_t i = 0; i < hit_class_count; ++i) counts[i] += other.counts[i];
    return *this;
}

std::uint64_t HitClassCounts::total() const { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); }

std::uint64_t HitClassCounts::faults_of_ours() const {
    return (*this)[HitClass::sw_leak] + (*this)[HitClass::sw_false] + (*this)[HitClass::t_err];
}

std::uint64_t HitClassCounts::faults_of_hardware() const {
    return (*this)[HitClass::hw_leak] + (*this)[HitClass::hw_false] + (*this)[HitClass::hw_t_err] +
           (*this)[HitClass::hw_range];
}

double HitClassCounts::bound_95() const { return upper_bound_95(faults_of_ours() + faults_of_hardware(), total()); }

HitClassCounts count(std::span<const HitClass> classes) {
    HitClassCounts counts;
    for (const HitClass kind : classes) counts.add(kind);
    return counts;
}

}  // namespace twinray
