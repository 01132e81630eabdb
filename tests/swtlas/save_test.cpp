// A built SwTlas that is saved and loaded again; and files with trees of the largest depth, which no builder makes.
#include "engine/core/files.h"
#include "swtlas/saved.h"
#include "test_program.trace_program.h"
#include "tests/scene/temp_dir.h"
#include "tests/support/sw_build.h"
#include "validation/reference/aimed_rays.h"

namespace twinray {
namespace {

using test::error_of;
using test::expect_contains;
using test::expect_error;

class SwSave : public test::VulkanTest {
  protected:
    void move_on_device(SwTlas& accel, AccelHandle handle, const std::vector<Transform>& transforms) {
        const Buffer source = device_copy(transforms);
        accel.update_transforms(handle, source.ref<Transform>(), transforms.size());
        accel.sync();
    }

    // Pushes geometries of every kind, one of them erased, options, and transforms that only the device knows.
    std::vector<AccelHandle> fill(SwTlas& accel) {
        std::vector<AccelHandle> handles;
        handles.push_back(
            accel.push(test::with_seam(make_icosphere(3)), Transform::translation({2, 0, 0}), {.custom_index = 7}));
        const AccelHandle gone = accel.push(make_soup(10, 4));
        Mesh bad = make_soup(300, 5);
        bad.positions[40].x = NAN;
        handles.push_back(
            accel.push(bad, std::vector<Transform>(2),
                       std::vector<InstanceOptions>{{.mask = 0x0f, .flip_facing = true}, {.mask = 0xf0}}));
        handles.push_back(accel.push(Mesh{}));
        handles.push_back(
            accel.push(make_soup(1, 6), Transform{}, {.custom_index = 0xffffff, .disable_culling = true}));
        handles.push_back(accel.push(make_box(vec3(-0.2f), vec3(0.2f)), std::vector<Transform>(3)));
        accel.erase(gone);
        accel.sync();
        move_on_device(
            accel, handles.back(),
            {Transform::translation({0, 2, 0}), Transform::scaling({1, 0, 1}), Transform::translation({0, -2, NAN})});
        return handles;
    }

    // The hit of an any-hit query depends on the order of the top level, and refits keep an older one.
    void expect_equal_hits(SwTlas& a, SwTlas& b, bool same_top_level) {
        std::vector<Ray> rays = random_rays({vec3(-3), vec3(3)}, 20'000, 5);
        std::size_t hit_count = 0;
        for (const bool is_any : {false, true})
            for (const std::uint8_t mask : {std::uint8_t{0xff}, std::uint8_t{0x10}, std::uint8_t{0x02}})
                for (const Cull cull : {Cull::none, Cull::back}) {
                    const auto trace = [&](SwTlas& accel) {
                        const TraceDesc how{.mask = mask, .cull = cull};
                        return is_any ? accel.any_hits(rays, how) : accel.closest_hits(rays, how);
                    };
                    std::vector<Hit> first = trace(a), second = trace(b);
                    for (const Hit& hit : first) hit_count += hit.hit;
                    if (is_any && !same_top_level)
                        for (std::vector<Hit>* hits : {&first, &second})
                            for (Hit& hit : *hits) hit = {hit.hit, 0, 0, 0, 0, 0, 0, 0};
                    EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(Hit)), 0);
                }
        EXPECT_GT(hit_count, 3'000u);
    }

    test::TempDir folder_;
};

TEST_F(SwSave, WhatIsLoadedTracesBitForBitAndIsNotBuiltAgain) {
    SwTlas accel(context());
    const std::vector<AccelHandle> handles = fill(accel);
    accel.save(folder_ / "scene.swtlas");
    SwTlas::Loaded loaded = SwTlas::load(context(), folder_ / "scene.swtlas");
    ASSERT_EQ(loaded.handles.size(), handles.size());
    loaded.accel->sync();
    EXPECT_FALSE(loaded.accel->build_timings().empty());
    for (const PassTiming& pass : loaded.accel->build_timings())
        EXPECT_EQ(pass.name.find("triangles"), std::string::npos) << "built again";
    expect_equal_hits(accel, *loaded.accel, true);
    for (std::size_t i = 0; i < handles.size(); ++i) {
        const std::vector<InstanceState> before = accel.get_instances(handles[i]),
                                         after = loaded.accel->get_instances(loaded.handles[i]);
        ASSERT_EQ(after.size(), before.size());
        for (std::size_t k = 0; k < before.size(); ++k) {
            EXPECT_EQ(std::memcmp(&after[k].transform, &before[k].transform, sizeof(Transform)), 0);
            EXPECT_EQ(after[k].options, before[k].options);
        }
    }
    EXPECT_EQ(loaded.accel->world_bound().lo, accel.world_bound().lo);
    loaded.accel->save(folder_ / "again.swtlas");
    EXPECT_EQ(read_file(folder_ / "again.swtlas"), read_file(folder_ / "scene.swtlas"));
}

TEST_F(SwSave, WhatIsLoadedTakesEditsLikeAnyOther) {
    SwTlas accel(context());
    std::vector<AccelHandle> handles = fill(accel);
    accel.save(folder_ / "scene.swtlas");
    SwTlas::Loaded loaded = SwTlas::load(context(), folder_ / "scene.swtlas");
    const auto edit = [&](SwTlas& target, const std::vector<AccelHandle>& at) {
        target.sync();
        target.erase(at[3]);
        target.update(at[2], make_soup(50, 9));
        target.update_transform(at[0], Transform::translation({-1, 0, 1}));
        target.push(make_soup(20, 8), Transform::scaling({2, 2, 2}), {.custom_index = 99});
        target.sync();
        move_on_device(target, at[4], std::vector<Transform>(3, Transform::translation({0, 0, 1})));
        target.update_transform_at(at[1], 1, Transform::translation({0, 1, 0}));
        target.sync();
    };
    edit(accel, handles);
    edit(*loaded.accel, loaded.handles);
    expect_equal_hits(accel, *loaded.accel, false);
    EXPECT_EQ(loaded.accel->n_geometries(), accel.n_geometries());
}

TEST_F(SwSave, BoxesAndNonOpaqueInstancesComeBackToo) {
    const std::vector<vec4> spheres = {vec4(0, 0, 0, 0.5f), vec4(1, 0, 0, 0.25f), vec4(0, 1, 1, 0.75f)};
    std::vector<Bounds> boxes;
    for (const vec4& sphere : spheres) boxes.push_back({vec3(sphere) - sphere.w, vec3(sphere) + sphere.w});
    const Buffer user = device_copy(spheres);
    SwTlas accel(context());
    accel.push(BoxesView{"spheres", boxes});
    accel.push(make_icosphere(3), Transform::translation({0, 0, -1}), {.non_opaque = true});
    accel.sync();
    accel.save(folder_ / "boxes.swtlas");
    const SwTlas::Loaded loaded = SwTlas::load(context(), folder_ / "boxes.swtlas");
    const std::vector<Ray> rays = random_rays({vec3(-2), vec3(2)}, 5'000, 9);
    std::vector<Hit> hits[2];
    for (AbstractAccel* each : {&accel, loaded.accel.get()}) {
        const auto program = each->make_program(test_program);
        hits[each != &accel] = each->closest_hits(rays, {.program = program.get(), .user_data = user.address()});
    }
    EXPECT_EQ(std::memcmp(hits[0].data(), hits[1].data(), rays.size() * sizeof(Hit)), 0);
    EXPECT_GT(std::count_if(hits[0].begin(), hits[0].end(), [](const Hit& h) { return h.hit && !h.instance_index; }),
              50);
    EXPECT_GT(std::count_if(hits[0].begin(), hits[0].end(), [](const Hit& h) { return h.instance_index == 1; }), 50);
}

TEST_F(SwSave, AnEmptyAcceleratorIsSavedToo) {
    SwTlas accel(context());
    accel.sync();
    accel.save(folder_ / "empty.swtlas");
    EXPECT_EQ(SwTlas::load(context(), folder_ / "empty.swtlas").accel->n_geometries(), 0u);
}

TEST_F(SwSave, PendingEditsAreNotSaved) {
    SwTlas accel(context());
    fill(accel);
    const AccelHandle handle = accel.push(make_soup(3, 1));
    expect_error("SwTlas: save: edits are pending; call sync() first", [&] { accel.save(folder_ / "a"); });
    accel.sync();
    accel.update_transform(handle, Transform::scaling({2, 2, 2}));
    expect_error("edits are pending", [&] { accel.save(folder_ / "a"); });
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a"));
}

TEST_F(SwSave, DamagedAndMissingFilesAreNamedAndLeaveNothingBehind) {
    SwTlas accel(context());
    fill(accel);
    const std::filesystem::path file = folder_ / "scene.swtlas";
    accel.save(file);
    context().wait_for_gpu();
    const Bytes good = read_file(file);
    const auto refusal_of = [&](const Bytes& bytes) {
        folder_.write("bad.swtlas", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        return error_of([&] { SwTlas::load(context(), folder_ / "bad.swtlas"); });
    };
    Bytes flipped = good;
    flipped[good.size() / 2] ^= 4;
    expect_contains(refusal_of(flipped), "bad.swtlas': geometry ");
    expect_contains(refusal_of(flipped), "damaged: the checksum is ");
    expect_contains(refusal_of(Bytes(good.begin(), good.end() - 1000)), "truncated");
    expect_contains(refusal_of({}), "not a saved SwTlas");
    expect_error("missing': file not found", [&] { SwTlas::load(context(), folder_ / "missing"); });
}

TEST_F(SwSave, AFailedSaveLeavesNoFile) {
    SwTlas accel(context());
    fill(accel);
    const std::filesystem::path file = folder_.write("scene.swtlas", "old");
    expect_error("No such file or directory", [&] { accel.save(folder_ / "no such folder/a"); });
    std::filesystem::create_directory(folder_ / "folder");
    folder_.write("folder/inside", "");
    expect_error("cannot be written: Is a directory", [&] { accel.save(folder_ / "folder"); });
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file.parent_path()), {}), 2);
    accel.save(file);
    EXPECT_EQ(SwTlas::load(context(), file).handles.size(), 5u);
}

// No builder is known to make such a tree of a mesh.
class DeepTrees : public test::VulkanTest, public testing::WithParamInterface<Layout> {
  protected:
    // Loads a tree with all boxes around the origin. A ray from there along (1, 1, 1) enters them all, and meets one
    // triangle of the fork `open`, after visiting the one farther in.
    std::unique_ptr<SwTlas> load(uint open) {
        Mesh mesh;
        float size = 0x1p-60f;
        const auto add = [&](float side) {
            const auto first = static_cast<uint>(mesh.positions.size());
            const float s = size * side;
            mesh.positions.insert(mesh.positions.end(), {{s, -s, s}, {-s, s, s}, {s, s, -s}});
            mesh.triangles.push_back({first, first + 1, first + 2});
        };
        add(-1);
        for (uint fork = 0; fork < test::TallTree::forks; ++fork) {
            size *= 1.6f;
            for (uint leaf = 0; leaf < 4; ++leaf) add(fork == open && leaf == 2 ? 1.0f : -1.0f);
        }
        const Geometry geometry(mesh, 1);
        const test::TallTree tall(reference::leaves_triangles(geometry.positions, mesh.triangles));
        const std::vector<CompressedRecord> records =
            reference::records_of_triangles(tall.tree, geometry.positions, mesh.triangles, width_of(GetParam()));
        const std::vector<SavedGeometry> saved = {
            {geometry, tall.bvh_of_records(), {}, {}, records, {make_instance_record(Transform{}, {})}}};
        const EncodedSave encoded = encode_save(GetParam(), saved);
        std::string file(reinterpret_cast<const char*>(encoded.head.data()), encoded.head.size());
        for (const std::span<const std::byte> piece : encoded.body)
            file.append(reinterpret_cast<const char*>(piece.data()), piece.size());
        return SwTlas::load(context(), folder_.write("deep.swtlas", file)).accel;
    }

    void expect_hit(SwTlas& accel, uint open) {
        const Ray ray{vec3(0), 0, vec3(1), INFINITY};
        const uint triangle = 4 * open + 3;
        const Hit closest = accel.closest_hits({&ray, 1}).front();
        EXPECT_EQ(std::pair(closest.hit, closest.primitive_index), std::pair(1u, triangle)) << "fork " << open;
        const Hit any = accel.any_hits({&ray, 1}).front();
        EXPECT_EQ(std::pair(any.hit, any.primitive_index), std::pair(1u, triangle)) << "fork " << open;
    }

    test::TempDir folder_;
};

INSTANTIATE_TEST_SUITE_P(In, DeepTrees, testing::Values(Layout::compressed4, Layout::compressed8),
                         [](const auto& layout) { return std::string(name_of(layout.param)); });

TEST_P(DeepTrees, NothingThatWaitsIsLost) {
    for (uint open = 0; open < test::TallTree::forks; ++open) expect_hit(*load(open), open);
}

TEST_P(DeepTrees, NothingThatWaitsIsLostBelowATopLevel) {
    for (uint open = 0; open < test::TallTree::forks; open += 3) {
        const std::unique_ptr<SwTlas> accel = load(open);
        accel->push(make_soup(10, 1), Transform::translation({0, 10, 0}));
        expect_hit(*accel, open);
    }
}

}  // namespace
}  // namespace twinray
