// The file format of a saved SwTlas, without a device: which files are accepted, which are refused, and how; and
// records of trees at the ends of their range.
#include "swtlas/saved.h"

#include "engine/core/files.h"
#include "tests/scene/temp_dir.h"
#include "tests/support/sw_build.h"

namespace twinray {
namespace {

using test::error_of;
using test::expect_contains;
using test::same_bytes;

SavedGeometry saved(Layout layout, const Mesh& mesh, std::size_t instances) {
    const Geometry geometry(mesh, 1);
    const std::vector<LeafBox> boxes = reference::leaves_triangles(geometry.positions, mesh.triangles);
    const reference::Codes codes = reference::morton(boxes, reference::centroids(boxes));
    const std::vector<uint> order = reference::sort(codes);
    std::vector<InstanceRecord> placed;
    for (uint i = 0; i < instances; ++i)
        placed.push_back(make_instance_record(Transform::translation({static_cast<float>(i), 0, 0}),
                                              {.custom_index = i, .mask = 0x55, .flip_facing = i % 2 == 1}));
    const auto count = static_cast<uint>(boxes.size());
    if (has_records(layout)) {
        const reference::Hierarchy tree = reference::hierarchy(boxes, codes, order, false);
        return {geometry,
                {tree.box.lo, tree.box.hi, {}, count ? 0 : NOTHING, count},
                {},
                {},
                reference::records_of_triangles(tree, geometry.positions, mesh.triangles, width_of(layout)),
                placed};
    }
    const reference::Hierarchy tree = reference::linked(reference::hierarchy(boxes, codes, order, true));
    return {geometry,   {tree.box.lo, tree.box.hi, {}, tree.root, count},
            tree.nodes, reference::encode_triangles(geometry.positions, mesh.triangles, order),
            {},         placed};
}

SavedGeometry saved_boxes() {
    std::vector<Bounds> boxes;
    std::vector<LeafBox> leaf_boxes;
    for (int i = 0; i < 7; ++i) {
        boxes.push_back({vec3(static_cast<float>(i)), vec3(static_cast<float>(i) + 2)});
        leaf_boxes.push_back({boxes.back().lo, boxes.back().hi});
    }
    const reference::Codes codes = reference::morton(leaf_boxes, reference::centroids(leaf_boxes));
    const std::vector<uint> order = reference::sort(codes);
    const reference::Hierarchy tree = reference::linked(reference::hierarchy(leaf_boxes, codes, order, true));
    std::vector<BvhTriangle> leaves;
    for (const uint i : order) leaves.push_back({boxes[i].lo, boxes[i].hi, vec3(0), i});
    return {
        Geometry(BoxesView{"boxes", boxes}), {tree.box.lo, tree.box.hi, {}, tree.root, 7}, tree.nodes, leaves, {}, {}};
}

std::vector<SavedGeometry> some_geometries(Layout layout) {
    Mesh bad = make_soup(9, 3);
    bad.name = "with a NaN";
    bad.positions[4].y = NAN;
    std::vector<SavedGeometry> geometries;
    for (const Mesh& mesh : {make_soup(20, 1), Mesh{}, make_soup(1, 2), bad})
        geometries.push_back(saved(layout, mesh, geometries.size()));
    if (layout == Layout::bvh2) geometries.push_back(saved_boxes());
    return geometries;
}

Bytes file_of(Layout layout, const std::vector<SavedGeometry>& geometries) {
    const EncodedSave encoded = encode_save(layout, geometries);
    Bytes file;
    const auto append = [&](std::span<const std::byte> piece) {
        for (const std::byte byte : piece) file.push_back(static_cast<std::uint8_t>(byte));
    };
    append(encoded.head);
    for (const std::span<const std::byte> piece : encoded.body) append(piece);
    return file;
}

// The file with an edited header and first entry, and right checksums for both.
Bytes resealed(Bytes file, const std::function<void(SavedHeader&, SavedEntry&)>& edit) {
    SavedHeader header;
    SavedEntry entry;
    std::memcpy(&header, file.data(), sizeof header);
    std::memcpy(&entry, file.data() + sizeof header, sizeof entry);
    const std::uint64_t entries_bytes = header.geometry_count * sizeof entry;
    edit(header, entry);
    std::memcpy(file.data() + sizeof header, &entry, sizeof entry);
    const std::span<const std::byte> all = std::as_bytes(std::span(file));
    header.entries_checksum = crc32_of(all.subspan(sizeof header, entries_bytes));
    std::memcpy(file.data(), &header, sizeof header);
    header.checksum = crc32_of(all.first(offsetof(SavedHeader, checksum)));
    std::memcpy(file.data(), &header, sizeof header);
    return file;
}

std::string refusal(const Bytes& file) {
    return error_of([&] { decode_save(file, "a.file"); });
}

class SavedFile : public testing::TestWithParam<Layout> {};
INSTANTIATE_TEST_SUITE_P(Every, SavedFile, testing::ValuesIn(all_layouts),
                         [](const auto& layout) { return std::string(name_of(layout.param)); });

TEST_P(SavedFile, ComesBackBitForBit) {
    const std::vector<SavedGeometry> before = some_geometries(GetParam());
    const auto [layout, after] = decode_save(file_of(GetParam(), before), "a.file");
    EXPECT_EQ(layout, GetParam());
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_EQ(after[i].mesh.name, before[i].mesh.name);
        EXPECT_EQ(after[i].mesh.non_finite_triangles, i == 3 ? 1u : 0u);
        EXPECT_TRUE(same_bytes(after[i].mesh.positions, before[i].mesh.positions));
        EXPECT_TRUE(same_bytes(after[i].mesh.triangles, before[i].mesh.triangles));
        EXPECT_TRUE(same_bytes(after[i].mesh.boxes, before[i].mesh.boxes));
        EXPECT_EQ(after[i].mesh.kind, before[i].mesh.kind);
        EXPECT_TRUE(same_bytes(after[i].nodes, before[i].nodes));
        EXPECT_TRUE(same_bytes(after[i].leaves, before[i].leaves));
        EXPECT_TRUE(same_bytes(after[i].records, before[i].records));
        EXPECT_TRUE(same_bytes(after[i].instances, before[i].instances));
        EXPECT_EQ(after[i].bvh.root, before[i].bvh.root);
        EXPECT_EQ(after[i].bvh.lo, before[i].bvh.lo);
    }
    EXPECT_TRUE(decode_save(file_of(GetParam(), {}), "a.file").geometries.empty());
}

TEST_P(SavedFile, EveryFlippedBitIsFound) {
    const Bytes good = file_of(GetParam(), some_geometries(GetParam()));
    for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
        Bytes bad = good;
        bad[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
        const std::string what = refusal(bad);
        ASSERT_EQ(what.rfind("'a.file': ", 0), 0u) << "bit " << bit << ": " << what;
    }
    std::printf("%zu flipped bits, each refused\n", good.size() * 8);
}

TEST_P(SavedFile, EveryOtherLengthIsFound) {
    const Bytes good = file_of(GetParam(), some_geometries(GetParam()));
    for (std::size_t bytes = 0; bytes < good.size(); ++bytes) {
        const std::string what = refusal(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(bytes)));
        ASSERT_NE(what.find(bytes < 8 ? "not a saved SwTlas" : "truncated"), std::string::npos)
            << bytes << ": " << what;
    }
    Bytes longer = good;
    longer.push_back(0);
    expect_contains(refusal(longer), text("it has ", longer.size(), " bytes, and its header says ", good.size()));
}

TEST_P(SavedFile, OtherFormatsAreNamed) {
    const Bytes good = file_of(GetParam(), some_geometries(GetParam()));
    const std::string words = "solid cube\nfacet normal 0 0 1\n outer loop\n and so on, more than a header has bytes\n";
    expect_contains(refusal(Bytes(words.begin(), words.end())), "not a saved SwTlas");
    const auto edited = [&](const std::function<void(SavedHeader&)>& edit) {
        return refusal(resealed(good, [&](SavedHeader& header, SavedEntry&) { edit(header); }));
    };
    expect_contains(edited([](SavedHeader& h) { h.version = 8; }), "format version 8; this library reads version 10");
    expect_contains(edited([](SavedHeader& h) { h.byte_order = 0x04030201; }), "another byte order");
    expect_contains(edited([](SavedHeader& h) { h.node_bytes = 80; }), "its node has 80 bytes; this library's has 64");
    expect_contains(edited([](SavedHeader& h) { h.leaf_bytes = 48; }), "its leaf has 48 bytes; this library's has 40");
    expect_contains(edited([](SavedHeader& h) { h.header_bytes = 64; }), "its header has 64 bytes");
    expect_contains(edited([](SavedHeader& h) { h.instance_bytes = 72; }), "its instance has 72 bytes");
    expect_contains(edited([](SavedHeader& h) { h.layout = all_layouts.size(); }), "unknown layout 3");
    expect_contains(edited([](SavedHeader& h) { h.entry_bytes = 80; }), "its entry has 80 bytes");
    expect_contains(edited([](SavedHeader& h) { h.record_bytes = 0; }), "its record has 0 bytes");
    expect_contains(edited([](SavedHeader& h) { h.reserved = 4; }), "its reserved word is 4, not 0");
}

// Nothing is allocated for these counts: 2^60 of anything would end the test.
TEST_P(SavedFile, CountsBeyondTheFileAreRefusedWhateverTheChecksumsSay) {
    const Bytes good = file_of(GetParam(), some_geometries(GetParam()));
    for (const std::uint64_t count : {std::uint64_t{1} << 60, ~std::uint64_t{0}, std::uint64_t{1'000'000}}) {
        expect_contains(refusal(resealed(good, [&](SavedHeader& h, SavedEntry&) { h.geometry_count = count; })),
                        text(count, " geometries of 104 bytes exceed"));
        for (const auto member :
             {&SavedEntry::name_bytes, &SavedEntry::positions, &SavedEntry::triangles, &SavedEntry::boxes,
              &SavedEntry::nodes, &SavedEntry::leaves, &SavedEntry::records, &SavedEntry::instances}) {
            const std::string what = refusal(resealed(good, [&](SavedHeader&, SavedEntry& e) { e.*member = count; }));
            expect_contains(what, "geometry 0: ");
            expect_contains(what, " exceed the ");
        }
    }
}

// Checksums are right here: such a file is made, not damaged.
std::string refusal_of_edited(Layout layout, const std::function<void(SavedGeometry&)>& edit) {
    std::vector<SavedGeometry> geometries = some_geometries(layout);
    edit(geometries.front());
    return refusal(file_of(layout, geometries));
}

TEST(SavedTrees, BinaryOnesThatCannotBeWalkedSafelyAreRefused) {
    const auto edited = [](const std::function<void(SavedGeometry&)>& edit) {
        return refusal_of_edited(Layout::bvh2, edit);
    };
    expect_contains(edited([](SavedGeometry& g) { g.nodes[3].child0 = 1000; }), "node 1000 of 19");
    expect_contains(edited([](SavedGeometry& g) { g.nodes[3].child1 = LEAF_BIT | 20; }), "leaf 20 of 20");
    expect_contains(edited([](SavedGeometry& g) { g.nodes[3].child0 = g.bvh.root; }), "reached twice");
    expect_contains(edited([](SavedGeometry& g) { g.nodes[3].child0 = g.nodes[3].child1; }), "unsound tree");
    expect_contains(edited([](SavedGeometry& g) { g.nodes[3].subtree0 += 2; }), "its edge is");
    expect_contains(edited([](SavedGeometry& g) { g.bvh.root = 19; }), "node 19 of 19");
    expect_contains(edited([](SavedGeometry& g) { g.bvh.root = NOTHING; }), "unsound tree");
    expect_contains(edited([](SavedGeometry& g) { g.nodes[g.bvh.root].lo0.x *= 1 + 0x1p-23f; }), "not the union");
    expect_contains(edited([](SavedGeometry& g) { g.leaves[5].primitive_index = 20; }), "primitive 20 of 20");
    expect_contains(edited([](SavedGeometry& g) { g.leaves.pop_back(); }), "19 leaves for 20 primitives");
    expect_contains(edited([](SavedGeometry& g) { g.nodes.pop_back(); }), "18 nodes, not 19");
    expect_contains(edited([](SavedGeometry& g) {
                        std::vector<uvec3> triangles(g.mesh.triangles.begin(), g.mesh.triangles.end());
                        triangles[7].y = 60;
                        g.mesh.triangles = std::move(triangles);
                    }),
                    "triangle 7 has vertex index 60");
    expect_contains(edited([](SavedGeometry& g) {
                        g.scale = 0x1p100f;
                        g.mesh.positions = times(g.mesh.positions, 0x1p40f);
                    }),
                    "a position exceeds float32 at scale");
    expect_contains(edited([](SavedGeometry& g) { g.mesh.kind = 2; }), "unknown kind of geometry 2");
    expect_contains(edited([](SavedGeometry& g) { g.mesh.kind = GEOMETRY_BOXES; }), "20 triangles of 60 positions");
    expect_contains(edited([](SavedGeometry& g) { g = saved_boxes(), g.mesh.boxes[2].hi.x = INFINITY; }), "box 2 from");
    expect_contains(edited([](SavedGeometry& g) { g = saved_boxes(), g.leaves[2].v1.x += 1; }), "not the union");
    expect_contains(edited([](SavedGeometry& g) { g.records.resize(1); }), "1 records in layout bvh2");
}

TEST(SavedTrees, RecordsThatCannotBeWalkedSafelyAreRefused) {
    const auto edited = [](const std::function<void(SavedGeometry&)>& edit) {
        return refusal_of_edited(Layout::compressed4, edit);
    };
    const auto leaf_of = [](SavedGeometry& g, uint primitive) -> CompressedRecord& {
        return *std::ranges::find(g.records, LEAF_BIT | primitive, [](const CompressedRecord& r) { return r.a.w; });
    };
    expect_contains(edited([](SavedGeometry& g) { g.records[0].a.w = 3u << 26 | 1000; }), "record 1000 of 33");
    expect_contains(edited([](SavedGeometry& g) { g.records[0].a.w = 3u << 26; }), "record 0 is reached twice");
    expect_contains(edited([](SavedGeometry& g) { g.records[0].a.w |= 1u << 24; }), "of 33");
    expect_contains(edited([](SavedGeometry& g) { g.records[0].a.w += 1; }), "unsound tree");
    expect_contains(edited([](SavedGeometry& g) { g.records[0].a.w |= 7u << 26; }), "has 7 children");
    expect_contains(edited([](SavedGeometry& g) { g.bvh.root = NOTHING; }), "the root is record");
    expect_contains(edited([](SavedGeometry& g) { g.bvh.lo.x -= 1; }), "not the union");
    expect_contains(edited([](SavedGeometry& g) { g.records[0].b.y -= 1; }), "lies in planes");
    expect_contains(edited([&](SavedGeometry& g) { leaf_of(g, 5).a.w = LEAF_BIT | 20; }), "primitive 20 of 20");
    expect_contains(edited([&](SavedGeometry& g) { leaf_of(g, 5).b.y ^= 1; }),
                    "primitive 5 does not have its vertices");
    expect_contains(edited([](SavedGeometry& g) { g.records.pop_back(); }), "32 records for 20 leaves, not 33");
    expect_contains(edited([](SavedGeometry& g) { g.leaves.resize(1); }), "1 leaves and 33 records in layout");
    expect_contains(edited([](SavedGeometry& g) {
                        *std::ranges::find(g.records, 0u, [](const CompressedRecord& r) { return r.a.w; }) =
                            g.records[0];
                    }),
                    "is not reached, and not none");
}

TEST(Compressed, PlanesLieOutsideAtAnySizeAndPlace) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int i = 0; i < 20'000; ++i) {
        const auto power = [&](int range) {
            return std::ldexp(1.0f, static_cast<int>(random() % (2 * range)) - range);
        };
        const vec3 place = vec3(unit(random), unit(random), unit(random)) * power(100);
        const float size = power(100);
        NodeChildren children{};
        std::vector<LeafBox> boxes;
        children.count = 2 + static_cast<uint>(random() % 3);
        for (uint child = 0; child < children.count; ++child) {
            const vec3 a = place + size * vec3(unit(random), unit(random), unit(random));
            const vec3 b = random() % 4 ? place + size * vec3(unit(random), unit(random), unit(random)) : a;
            children.box[child] = {min(a, b), max(a, b)};
            boxes.push_back(children.box[child]);
        }
        std::vector<CompressedRecord> records = {
            encode_node(children, given_order((1u << children.count) - 1, 0), 1, 4).first};
        for (uint child = 0; child < children.count; ++child) records.push_back(encode_instance(child));
        LeafBox all = empty_box();
        for (const LeafBox& box : boxes) all = {min(all.lo, box.lo), max(all.hi, box.hi)};
        const Bvh bvh{all.lo, all.hi, {}, 0, children.count};
        const TreeCheck check = check_tree(bvh, records, boxes);
        ASSERT_TRUE(check.violations.empty()) << check.violations.front();
    }
    EXPECT_LT(record_count(static_cast<uint>(Geometry::max_primitives), 8), MOST_RECORDS);
}

TEST(Compressed, OriginsKeepAnExponentAndLieCloseBelow) {
    std::mt19937 random(3);
    for (int i = 0; i < 100'000; ++i) {
        const auto bits = static_cast<uint>(random() & 0x80ffffffu) | static_cast<uint>(random() % 0xf8) << 23;
        const float limit = uintBitsToFloat(bits);
        const auto exponent = 1 + static_cast<uint>(random() % 253);
        const float origin = origin_below(limit, exponent);
        EXPECT_EQ(floatBitsToUint(origin) & 0x1ffu, exponent) << limit;
        EXPECT_LE(origin, limit) << exponent;
        EXPECT_LE(double{limit} - double{origin}, std::ldexp(std::abs(double{limit}), -14) + 0x1p-140) << exponent;
    }
}

TEST(RecordCheck, RecordsBelowDifferentChildrenMayNotMix) {
    const LeafBox box{vec3(0), vec3(1)};
    NodeChildren children{};
    children.count = 2;
    children.box[0] = children.box[1] = box;
    const auto node = [&](uint first) { return encode_node(children, given_order(3, 0), first, 4).first; };
    const auto violations = [&](uint of_first, uint of_second, uint of_grandchild) {
        std::vector<CompressedRecord> records = {node(1), node(of_first), node(of_second)};
        for (uint leaf = 0, record = 3; record < 9; ++record)
            records.push_back(record == of_first ? node(of_grandchild) : encode_instance(leaf++));
        const std::vector<LeafBox> boxes(5, box);
        return check_tree({box.lo, box.hi, {}, 0, 5}, records, boxes).violations;
    };
    EXPECT_EQ(violations(3, 7, 5), std::vector<std::string>{});
    EXPECT_EQ(violations(3, 5, 7), std::vector<std::string>{"records below the children of record 0 mix"});
}

// Their sizes are infinite, and the middles of some are NaN.
TEST(Compressed, BoxesWithoutAnEndAreLeavesAsAnyOther) {
    const vec3 most(3e38f), end(INFINITY);
    for (const uint width : {4u, 8u})
        for (const uint n : {2u, 4u, 8u, 16u, 100u}) {
            std::vector<LeafBox> boxes(n, {-most, most});
            boxes[n / 2] = {-end, end};
            boxes[n - 1] = {vec3(0, -INFINITY, 0), vec3(1, INFINITY, 1)};
            const reference::Codes codes = reference::morton(boxes, reference::centroids(boxes));
            const reference::Hierarchy tree = reference::hierarchy(boxes, codes, reference::sort(codes), false);
            const std::vector<CompressedRecord> records = reference::records_of_instances(tree, n, width);
            ASSERT_EQ(records.size(), record_count(n, width));
            const TreeCheck check = check_tree({tree.box.lo, tree.box.hi, {}, 0, n}, records, boxes);
            for (const std::string& violation : check.violations)
                EXPECT_NE(violation.find("lies in planes"), std::string::npos)  // planes end at 2^120
                    << n << " leaves, nodes of " << width << ": " << violation;
        }
}

class CompressedPaths : public testing::TestWithParam<uint> {};
INSTANTIATE_TEST_SUITE_P(OfNodesOf, CompressedPaths, testing::Values(4u, 8u));

TEST_P(CompressedPaths, AreNoDeeperThanAStackIsMadeFor) {
    std::vector<LeafBox> leaf_boxes;
    float size = 0x1p-100f;
    for (uint i = 0; i < test::TallTree::leaves; ++i) {
        leaf_boxes.push_back({vec3(-size), vec3(size)});
        if (i % 4 == 0) size *= 4;
    }
    const test::TallTree tall(leaf_boxes);
    const Bvh binary{tall.tree.box.lo, tall.tree.box.hi, {}, tall.tree.root, tall.leaves};
    const TreeCheck tree = check_tree(binary, reference::linked(tall.tree).nodes, tall.boxes);
    EXPECT_TRUE(tree.violations.empty()) << tree.violations.front();
    EXPECT_EQ(tree.depth, DEEPEST_TREE);
    const TreeCheck check = check_tree(tall.bvh_of_records(),
                                       reference::records_of_instances(tall.tree, tall.leaves, GetParam()), tall.boxes);
    EXPECT_TRUE(check.violations.empty()) << check.violations.front();
    EXPECT_LE(check.depth, DEEPEST_RECORDS);
    if (GetParam() == 4) {
        EXPECT_EQ(check.depth, DEEPEST_RECORDS);
    }
}

}  // namespace
}  // namespace twinray
