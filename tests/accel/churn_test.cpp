// Long histories of edits, checked by the float64 reference after every sync.
#include "engine/core/context.h"
#include "validation/reference/aimed_rays.h"
#include "tests/accel/accel_fixture.h"

namespace twinray {
namespace {

class Churn : public test::AccelTest {
  protected:
    // The expected contents of the accelerator, in push order.
    struct Placed {
        AccelHandle handle;
        Mesh mesh;
        std::vector<Transform> transforms;
        std::vector<Buffer> sources = {};  // device memory that the next sync reads
    };

    Transform random_transform() {
        Transform transform;
        for (vec4& row : transform.rows) row = vec4(unit_(random_), unit_(random_), unit_(random_), 4 * unit_(random_));
        return fault_of(transform).empty() ? transform : Transform{};
    }
    std::vector<Transform> random_transforms(std::size_t count) {
        std::vector<Transform> transforms;
        for (std::size_t i = 0; i < count; ++i) transforms.push_back(random_transform());
        return transforms;
    }
    Mesh random_mesh() {
        const uint size = static_cast<uint>(random_() % 40);
        return random_() % 4 == 0 ? make_box(vec3(-0.5f), vec3(0.5f)) : make_soup(size, static_cast<uint>(random_()));
    }
    Placed& any_placed() { return placed_[random_() % placed_.size()]; }

    void TearDown() override {
        placed_.clear();
        test::AccelTest::TearDown();
    }
    void push();
    void erase();
    void move_by_host();
    void move_one();
    void append();
    void erase_one();
    void move_by_device();
    void move();
    std::vector<vec3> random_positions(const Mesh& mesh);
    void move_vertices();
    void edit();
    void aim_at_triangles(const Scene& scene, std::vector<Ray>& rays);
    void expect_exact_counts();
    void expect_agreement(std::size_t rays);
    std::uint64_t memory() {
        context().wait_for_gpu();
        return context().allocated_bytes();
    }

    std::mt19937 random_{20'261'121};
    std::uniform_real_distribution<float> unit_{-1, 1};
    std::vector<Placed> placed_;
    std::size_t vertex_edits_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Every, Churn, testing::Values(test::Kind::software, test::Kind::pipeline), test::name_of_kind);
INSTANTIATE_TEST_SUITE_P(Full, Churn, testing::Values(test::Kind::ray_query), test::name_of_kind);

void Churn::push() {
    Placed placed{{}, random_mesh(), random_transforms(random_() % 4)};
    placed.handle = accel().push(placed.mesh, placed.transforms);
    placed_.push_back(std::move(placed));
}

void Churn::erase() {
    const std::size_t victim = random_() % placed_.size();
    EXPECT_TRUE(accel().erase(placed_[victim].handle));
    EXPECT_FALSE(accel().erase(placed_[victim].handle));
    placed_.erase(placed_.begin() + static_cast<std::ptrdiff_t>(victim));
}

void Churn::move_by_host() {
    Placed& placed = any_placed();
    placed.transforms = random_transforms(placed.transforms.size());
    accel().update_transforms(placed.handle, placed.transforms);
}

void Churn::move_one() {
    Placed& placed = any_placed();
    if (placed.transforms.empty()) return;
    const std::size_t index = random_() % placed.transforms.size();
    placed.transforms[index] = random_transform();
    accel().update_transform_at(placed.handle, index, placed.transforms[index]);
}

void Churn::append() {
    Placed& placed = any_placed();
    const std::vector<Transform> more = random_transforms(random_() % 4);
    EXPECT_EQ(accel().append_instances(placed.handle, more), placed.transforms.size());
    placed.transforms.insert(placed.transforms.end(), more.begin(), more.end());
}

void Churn::erase_one() {
    Placed& placed = any_placed();
    if (placed.transforms.empty()) return;
    accel().sync();  // transforms from device memory cannot be pending
    const std::size_t index = random_() % placed.transforms.size();
    accel().erase_instance(placed.handle, index);
    placed.transforms.erase(placed.transforms.begin() + static_cast<std::ptrdiff_t>(index));
}

void Churn::move_by_device() {
    Placed& placed = any_placed();
    if (placed.transforms.empty()) return;
    placed.transforms = random_transforms(placed.transforms.size());
    placed.sources.push_back(device_copy(placed.transforms));
    accel().update_transforms(placed.handle, placed.sources.back().ref<Transform>(), placed.transforms.size());
}

// Returns slightly changed positions most of the time; now and then a corner is not finite.
std::vector<vec3> Churn::random_positions(const Mesh& mesh) {
    std::vector<vec3> positions = mesh.positions;
    const float size = random_() % 4 == 0 ? 1.0f : 0.05f;
    for (vec3& position : positions) {
        position = is_finite(position) ? position : vec3(0);
        position += size * vec3(unit_(random_), unit_(random_), unit_(random_));
    }
    if (!positions.empty() && random_() % 8 == 0) positions[random_() % positions.size()].y = NAN;
    return positions;
}

void Churn::move_vertices() {
    Placed& placed = any_placed();
    placed.mesh.positions = random_positions(placed.mesh);
    ++vertex_edits_;
    if (placed.mesh.positions.empty() || random_() % 2 == 0)
        return accel().update_vertices(placed.handle, placed.mesh.positions);
    placed.sources.push_back(device_copy(placed.mesh.positions));
    accel().update_vertices(placed.handle, placed.sources.back().ref<float>(), placed.mesh.positions.size());
}

void Churn::move() {
    const auto kind = random_() % 7;
    if (kind == 0) return move_by_host();
    if (kind == 1) return move_one();
    if (kind == 5) return append();
    if (kind == 6) return erase_one();
    if (kind > 2) return move_vertices();
    move_by_device();
}

void Churn::edit() {
    const auto kind = random_() % 16;
    if (placed_.empty() || (kind < 3 && placed_.size() < 24)) return push();
    if (kind < 6) return erase();
    if (kind < 14) return move();
    Placed& placed = any_placed();
    placed.mesh = random_mesh();
    accel().update(placed.handle, placed.mesh);
}

void Churn::expect_exact_counts() {
    std::size_t instances = 0;
    for (const Placed& placed : placed_) {
        instances += placed.transforms.size();
        ASSERT_EQ(accel().n_instances(placed.handle), placed.transforms.size());
    }
    accel().sync();
    uint instance = 0;
    for (const Placed& placed : placed_)
        for (std::size_t i = 0; i < placed.transforms.size(); ++i, ++instance) {
            const Hit hit{1, 1, 0, 0, 0, 0, instance, 0};
            ASSERT_EQ(accel().handle_of(hit), placed.handle);
            ASSERT_EQ(accel().index_in_handle(hit), i);
        }
    ASSERT_EQ(accel().n_instances(), instances);
    ASSERT_EQ(accel().n_geometries(), placed_.size());
}

// Aims half of the rays at triangles, since few would hit anything otherwise.
void Churn::aim_at_triangles(const Scene& scene, std::vector<Ray>& rays) {
    if (scene.instances.empty()) return;
    for (std::size_t i = 0; i < rays.size(); i += 2) {
        const Instance& instance = scene.instances[random_() % scene.instances.size()];
        const Mesh& mesh = scene.meshes[instance.mesh];
        if (mesh.triangles.empty()) continue;
        const uvec3 corners = mesh.triangles[random_() % mesh.triangles.size()];
        const vec3 middle = (mesh.positions[corners.x] + mesh.positions[corners.y] + mesh.positions[corners.z]) / 3.0f;
        rays[i].direction = transform_point(instance.transform, middle) - rays[i].origin;
    }
}

void Churn::expect_agreement(std::size_t count) {
    Scene scene;
    for (const Placed& placed : placed_) {
        for (const Transform& transform : placed.transforms)
            scene.instances.push_back({"", static_cast<uint>(scene.meshes.size()), transform});
        scene.meshes.push_back(placed.mesh);
    }
    Bounds bounds = bounds_of(scene);
    if (bounds.is_empty()) bounds = {vec3(-1), vec3(1)};
    std::vector<Ray> rays = random_rays(bounds, count, random_());
    aim_at_triangles(scene, rays);
    const std::vector<Hit> hits = accel().closest_hits(rays);
    const ReferenceScene reference = ReferenceScene::of(scene);
    const HitClassCounts classes = classes_of(reference, rays, hits);
    ASSERT_EQ(classes.faults_of_ours() + classes.faults_of_hardware(), 0u);
}

// Makes ten edits per round. The pipeline differs from ray queries in how it traces, not in what edits do.
TEST_P(Churn, LongHistoriesOfEditsAgreeWithTheReference) {
    const int rounds = GetParam() == test::Kind::pipeline ? 200 : 1000;
    closest(test::down(0, 0));  // makes what the first trace makes
    const std::uint64_t before = memory();
    for (int round = 0; round < rounds; ++round) {
        const bool only_moves = round % 4 != 0 && !placed_.empty();  // so that refits follow each other
        for (int i = 0; i < 10; ++i) only_moves ? move() : edit();
        ASSERT_NO_FATAL_FAILURE(expect_exact_counts()) << "round " << round;
        ASSERT_NO_FATAL_FAILURE(expect_agreement(32)) << "round " << round;
        for (Placed& placed : placed_) placed.sources.clear();
    }
    while (!placed_.empty()) erase();
    accel().sync();
    accel().sync();
    EXPECT_EQ(memory(), before) << "bytes in live allocations";
    EXPECT_GT(vertex_edits_, 2u * static_cast<unsigned>(rounds));
}

// Compares with the memory that the allocator has handed out, which rounds each buffer up.
TEST_P(Churn, MemoryIsToldBeforeAndAfterItIsTaken) {
    accel().sync();
    const std::uint64_t empty = memory() - accel().memory_usage().total();
    std::vector<GeometrySize> sizes;
    std::size_t buffers = 8, instances = 0;
    for (const uint count : {1u, 100u, 3000u}) {
        placed_.push_back({{}, make_soup(count, count), random_transforms(count)});
        placed_.back().handle = accel().push(placed_.back().mesh, placed_.back().transforms);
        sizes.push_back({placed_.back().mesh.positions.size(), count});
        instances += count;
        buffers += 4;
    }
    const BuildBytes needed = accel().memory_requirements();
    const std::unique_ptr<AbstractAccel> fresh = make_accel();
    for (const Placed& placed : placed_) fresh->push(placed.mesh, placed.transforms);
    EXPECT_EQ(accel().memory_requirements(sizes, instances).structures, fresh->memory_requirements().structures);
    accel().sync();
    EXPECT_EQ(accel().memory_usage().structures(), needed.structures);
    EXPECT_GT(needed.scratch, instances * sizeof(uint));
    EXPECT_EQ(accel().memory_requirements().structures, 0u) << "everything is built";
    const auto expect_told = [&](const char* when) {
        const std::uint64_t told = empty + accel().memory_usage().total(), held = memory();
        EXPECT_GE(held + 64, told) << when;
        EXPECT_LE(held, told + 256 * buffers) << when;
    };
    expect_told("built");
    EXPECT_EQ(accel().memory_usage().vertices, 0u);
    accel().update_vertices(placed_[2].handle, placed_[2].mesh.positions);
    accel().sync();
    EXPECT_GE(accel().memory_usage().vertices, 3000u * 4 * sizeof(vec3));
    expect_told("moved");
    const std::uint64_t large = accel().memory_usage().scene;
    accel().erase(placed_[2].handle);
    accel().sync();
    EXPECT_LT(accel().memory_usage().scene, large / 10) << "the top level shrinks";
    expect_told("erased");
}

TEST_P(Churn, FiveHundredMovesKeepEverythingInPlace) {
    for (int i = 0; i < 8; ++i) push();
    accel().sync();
    move_by_host();
    for (Placed& placed : placed_) accel().update_vertices(placed.handle, placed.mesh.positions);
    closest(test::down(0, 0));
    const AccelView view = accel().view();
    const std::uint64_t before = memory();
    for (int round = 0; round < 500; ++round) {
        move_by_host();
        move_one();
        move_vertices();
        accel().sync();
        for (Placed& placed : placed_) placed.sources.clear();
        ASSERT_EQ(accel().view().scene, view.scene);
        ASSERT_EQ(accel().revision(), view.revision);
        if (round % 25 != 0) continue;
        ASSERT_NO_FATAL_FAILURE(expect_agreement(64)) << "round " << round;
    }
    EXPECT_LE(memory(), before) << "bytes in live allocations";
}

TEST_P(Churn, ManyInstancesDrainToNothingAndFillAgain) {
    closest(test::down(0, 0));
    const std::uint64_t before = memory();
    for (int round = 0; round < 2; ++round) {
        for (int i = 0; i < 50; ++i) {
            placed_.push_back({{}, random_mesh(), random_transforms(100)});
            placed_.back().handle = accel().push(placed_.back().mesh, placed_.back().transforms);
        }
        ASSERT_NO_FATAL_FAILURE(expect_exact_counts());
        ASSERT_NO_FATAL_FAILURE(expect_agreement(500));
        while (!placed_.empty()) erase();
        EXPECT_EQ(closest(test::down(0, 0)).hit, 0u);
        EXPECT_TRUE(accel().world_bound().is_empty());
    }
    accel().sync();
    EXPECT_EQ(memory(), before) << "bytes in live allocations";
}

}  // namespace
}  // namespace twinray
