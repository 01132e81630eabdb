#include "swtlas/saved.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "swtlas/tree.h"
#include "swtlas/triangle_pairs.h"

namespace twinray {
namespace {

// Like PNG's magic: it differs from text, and shows a conversion of line ends.
constexpr char magic[8] = {'\x89', 'T', 'W', 'R', '\r', '\n', '\x1a', '\n'};
constexpr uint byte_order = 0x01020304u;

template <class Array>
std::span<const std::byte> bytes_of(const Array& values) {
    return std::as_bytes(std::span(values));
}

uint checksum_of(const SavedHeader& header) {
    return crc32_of(std::as_bytes(std::span(&header, 1)).first(offsetof(SavedHeader, checksum)));
}

SavedHeader own_header() {
    SavedHeader header{};
    std::copy(std::begin(magic), std::end(magic), header.magic);
    header.version = saved_version;
    header.byte_order = byte_order;
    header.header_bytes = sizeof(SavedHeader);
    header.entry_bytes = sizeof(SavedEntry);
    header.node_bytes = sizeof(BvhNode);
    header.leaf_bytes = sizeof(BvhTriangle);
    header.record_bytes = sizeof(CompressedRecord);
    header.instance_bytes = sizeof(InstanceRecord);
    return header;
}

void check_header(const SavedHeader& found, std::size_t file_bytes) {
    const SavedHeader own = own_header();
    if (checksum_of(found) != found.checksum)
        fail("damaged: the header's checksum is ", checksum_of(found), ", not ", found.checksum);
    const std::tuple<const char*, uint, uint> sizes[] = {
        {"header", found.header_bytes, own.header_bytes}, {"entry", found.entry_bytes, own.entry_bytes},
        {"node", found.node_bytes, own.node_bytes},       {"leaf", found.leaf_bytes, own.leaf_bytes},
        {"record", found.record_bytes, own.record_bytes}, {"instance", found.instance_bytes, own.instance_bytes}};
    for (const auto& [name, there, here] : sizes)
        if (there != here) fail("its ", name, " has ", there, " bytes; this library's has ", here);
    if (found.reserved != 0) fail("its reserved word is ", found.reserved, ", not 0");
    if (found.layout >= all_layouts.size()) fail("unknown layout ", found.layout);
    if (found.file_bytes != file_bytes)
        fail("truncated or joined: it has ", file_bytes, " bytes, and its header says ", found.file_bytes);
}

// Takes arrays off the front of the file and checks that each fits into the rest.
class Reader {
  public:
    explicit Reader(std::span<const std::uint8_t> file) : rest_(std::as_bytes(file)) {}

    template <class T>
    std::vector<T> take(std::uint64_t count, const char* what) {
        if (count > rest_.size() / sizeof(T))
            fail(count, " ", what, " of ", sizeof(T), " bytes exceed the ", rest_.size(), " bytes left in it");
        std::vector<T> values(count);
        const std::span<const std::byte> bytes = rest_.first(count * sizeof(T));
        if (count) std::memcpy(values.data(), bytes.data(), bytes.size());
        rest_ = rest_.subspan(bytes.size());
        return values;
    }
    std::span<const std::byte> rest() const { return rest_; }

  private:
    std::span<const std::byte> rest_;
};

SavedHeader read_header(Reader& reader, std::size_t file_bytes) {
    if (const std::span<const std::byte> rest = reader.rest();
        rest.size() < sizeof magic || std::memcmp(rest.data(), magic, sizeof magic) != 0)
        fail("not a saved SwTlas: it does not begin with the right 8 bytes");
    if (file_bytes < sizeof(SavedHeader))
        fail("truncated: ", file_bytes, " bytes; the header alone has ", sizeof(SavedHeader));
    const SavedHeader header = reader.take<SavedHeader>(1, "headers").front();
    if (header.byte_order != byte_order)
        fail("written on a machine of another byte order (", header.byte_order, ", not ", byte_order, ")");
    if (header.version != saved_version)
        fail("format version ", header.version, "; this library reads version ", saved_version);
    check_header(header, file_bytes);
    return header;
}

// Checks the data that traversal relies on: it follows indices without checking them.
void check_bvh2(const SavedGeometry& geometry) {
    const std::size_t primitives = geometry.mesh.primitive_count();
    if (geometry.leaves.size() != primitives)
        fail("a tree of ", geometry.leaves.size(), " leaves for ", primitives, " primitives");
    if (const std::size_t inner = std::max<std::size_t>(primitives, 1) - 1; geometry.nodes.size() != inner)
        fail("a tree of ", geometry.nodes.size(), " nodes, not ", inner);
    const bool has_boxes = geometry.mesh.kind == GEOMETRY_BOXES;
    std::vector<LeafBox> boxes;
    boxes.reserve(primitives);
    for (const BvhTriangle& leaf : geometry.leaves) {
        if (leaf.primitive_index >= primitives) fail("primitive ", leaf.primitive_index, " of ", primitives);
        boxes.push_back(has_boxes ? LeafBox{leaf.v0, leaf.v1} : box_of_triangle(leaf));
    }
    const TreeCheck check = check_tree(geometry.bvh, geometry.nodes, boxes);
    if (!check.violations.empty()) fail("unsound tree: ", check.violations.front());
}

// Returns a mesh as the builder sees it.
BuildTree source_of(const Geometry& mesh) {
    BuildTree source{};
    if (mesh.kind == GEOMETRY_BOXES) {
        source.positions = Floats::to(&mesh.boxes.data()->lo.x);
        return source;
    }
    source.positions = Floats::to(&mesh.positions.data()->x);
    source.indices = Uints::to(&mesh.triangles.data()->x);
    return source;
}

// Returns the leaf that a record was made from.
Leaf checked_leaf(const CompressedRecord& record, const Geometry& mesh) {
    const std::size_t primitives = mesh.primitive_count();
    const uint first = index_in(record);
    if (first >= primitives) fail("primitive ", first, " of ", primitives);
    if (!is_pair(record)) return make_leaf(first, first);
    const uint second = second_index_in(record);
    if (mesh.kind != GEOMETRY_TRIANGLES || second <= first || second >= primitives)
        fail("no leaf can have primitives ", first, " and ", second, " of ", primitives);
    return leaf_of(record);
}

void check_records(Layout layout, const SavedGeometry& geometry) {
    const auto primitives = static_cast<uint>(geometry.mesh.primitive_count());
    if (const std::size_t count = record_count(geometry.bvh.leaf_count, width_of(layout));
        geometry.records.size() != count)
        fail("a tree of ", geometry.records.size(), " records for ", geometry.bvh.leaf_count, " leaves, not ", count);
    if (primitives == 0) return;
    const BuildTree source = source_of(geometry.mesh);
    for (const CompressedRecord& record : geometry.records) {
        if (!is_leaf(record)) continue;
        const Leaf leaf = checked_leaf(record, geometry.mesh);
        if (const CompressedRecord right = encode_boxed_leaf(source, leaf, boxed_leaf(source, leaf));
            std::memcmp(&record, &right, sizeof right) != 0)
            fail("the record of primitive ", leaf.first, " does not have its vertices");
    }
    std::vector<LeafBox> boxes;
    boxes.reserve(primitives);
    for (uint i = 0; i < primitives; ++i) boxes.push_back(boxed_primitive(source, i).box);
    const TreeCheck check = check_tree(geometry.bvh, geometry.records, boxes);
    if (!check.violations.empty()) fail("unsound tree: ", check.violations.front());
    if (check.width != 0 && check.width != width_of(layout))
        fail("nodes of ", check.width, " children in layout ", name_of(layout));
}

// Returns Geometry::leaves of a sound tree.
std::vector<Leaf> leaves_in(std::span<const CompressedRecord> records) {
    if (!has_pairs(records)) return {};
    std::vector<Leaf> leaves;
    for (const CompressedRecord& record : records)
        if (is_leaf(record)) leaves.push_back(leaf_of(record));
    return leaves;
}

void check_structure(Layout layout, const SavedGeometry& geometry) {
    if (has_records(layout) ? !geometry.nodes.empty() || !geometry.leaves.empty() : !geometry.records.empty())
        fail(geometry.nodes.size(), " nodes, ", geometry.leaves.size(), " leaves and ", geometry.records.size(),
             " records in layout ", name_of(layout));
    if (!has_records(layout)) return check_bvh2(geometry);
    check_records(layout, geometry);
}

Geometry read_mesh(Reader& reader, const SavedEntry& entry) {
    const std::vector<char> characters = reader.take<char>(entry.name_bytes, "characters");
    const std::string_view name(characters.data(), characters.size());
    const std::vector<vec3> positions = reader.take<vec3>(entry.positions, "positions");
    const std::vector<uvec3> triangles = reader.take<uvec3>(entry.triangles, "triangles");
    const std::vector<Bounds> boxes = reader.take<Bounds>(entry.boxes, "boxes");
    const bool has_boxes = entry.kind == GEOMETRY_BOXES;
    if (!has_boxes && entry.kind != GEOMETRY_TRIANGLES) fail("unknown kind of geometry ", entry.kind);
    if (has_boxes ? !positions.empty() || !triangles.empty() : !boxes.empty())
        fail(triangles.size(), " triangles of ", positions.size(), " positions and ", boxes.size(), " boxes");
    if (has_boxes && entry.scale != 1) fail("boxes at scale ", entry.scale, ", not 1");
    if (has_boxes) return Geometry(BoxesView{name, boxes});
    if (int exponent = 0; std::frexp(entry.scale, &exponent) != 0.5f || std::abs(exponent) > 101)
        fail("scale ", entry.scale, " is not a power of two between 2^-100 and 2^100");
    for (const vec3& position : positions)
        if (is_finite(position) && !is_finite(position * entry.scale))
            fail("a position exceeds float32 at scale ", entry.scale);
    return Geometry(MeshView(name, positions, triangles), 1);
}

SavedGeometry read_geometry(Reader& reader, Layout layout, const SavedEntry& entry) {
    const std::span<const std::byte> all = reader.rest();
    Geometry mesh = read_mesh(reader, entry);
    std::vector<BvhNode> nodes = reader.take<BvhNode>(entry.nodes, "nodes");
    std::vector<BvhTriangle> leaves = reader.take<BvhTriangle>(entry.leaves, "leaves");
    std::vector<CompressedRecord> records = reader.take<CompressedRecord>(entry.records, "records");
    std::vector<InstanceRecord> instances = reader.take<InstanceRecord>(entry.instances, "instances");
    if (const uint found = crc32_of(all.first(all.size() - reader.rest().size())); found != entry.checksum)
        fail("damaged: the checksum is ", found, ", not ", entry.checksum);
    const auto leaf_count = has_records(layout) ? std::ranges::count_if(records, is_leaf) : std::ssize(leaves);
    const Bvh bvh{entry.lo, entry.hi, {}, entry.root, static_cast<uint>(leaf_count)};
    SavedGeometry geometry{std::move(mesh),      bvh,        std::move(nodes), std::move(leaves), std::move(records),
                           std::move(instances), entry.scale};
    check_structure(layout, geometry);
    if (has_records(layout)) geometry.mesh.leaves = leaves_in(geometry.records);
    return geometry;
}

DecodedSave read_all(std::span<const std::uint8_t> file) {
    Reader reader(file);
    const SavedHeader header = read_header(reader, file.size());
    const std::vector<SavedEntry> entries = reader.take<SavedEntry>(header.geometry_count, "geometries");
    if (const uint found = crc32_of(bytes_of(entries)); found != header.entries_checksum)
        fail("damaged: the checksum of the list of geometries is ", found, ", not ", header.entries_checksum);
    DecodedSave decoded{static_cast<Layout>(header.layout), {}};
    std::uint64_t instances = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) try {
            decoded.geometries.push_back(read_geometry(reader, decoded.layout, entries[i]));
            instances += entries[i].instances;
        } catch (const Error& error) {
            fail("geometry ", i, ": ", error.what());
        }
    if (!reader.rest().empty()) fail(reader.rest().size(), " bytes too many");
    if (instances > max_instances) fail(instances, " instances; at most ", max_instances, " fit");
    return decoded;
}

}  // namespace

EncodedSave encode_save(Layout layout, std::span<const SavedGeometry> geometries) {
    EncodedSave file;
    std::vector<SavedEntry> entries;
    SavedHeader header = own_header();
    header.layout = static_cast<uint>(layout);
    header.geometry_count = geometries.size();
    header.file_bytes = sizeof(SavedHeader) + geometries.size() * sizeof(SavedEntry);
    for (const SavedGeometry& geometry : geometries) {
        const Geometry& mesh = geometry.mesh;
        uint checksum = 0;
        for (const std::span<const std::byte> array :
             {std::as_bytes(std::span(mesh.name)), bytes_of(mesh.positions), bytes_of(mesh.triangles),
              bytes_of(mesh.boxes), bytes_of(geometry.nodes), bytes_of(geometry.leaves), bytes_of(geometry.records),
              bytes_of(geometry.instances)}) {
            checksum = crc32_of(array, checksum);
            header.file_bytes += array.size();
            file.body.push_back(array);
        }
        entries.push_back({mesh.name.size(), mesh.positions.size(), mesh.triangles.size(), mesh.boxes.size(),
                           geometry.nodes.size(), geometry.leaves.size(), geometry.records.size(),
                           geometry.instances.size(), geometry.bvh.lo, geometry.bvh.hi, geometry.bvh.root, mesh.kind,
                           geometry.scale, checksum});
    }
    header.entries_checksum = crc32_of(bytes_of(entries));
    header.checksum = checksum_of(header);
    for (const std::span<const std::byte> part : {std::as_bytes(std::span(&header, 1)), bytes_of(entries)})
        file.head.insert(file.head.end(), part.begin(), part.end());
    return file;
}

DecodedSave decode_save(std::span<const std::uint8_t> file, const std::string& object) {
    try {
        return read_all(file);
    } catch (const Error& error) {
        fail("'", object, "': ", error.what());
    }
}

}  // namespace twinray
