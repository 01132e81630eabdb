#include "engine/scene/importers/gltf_file.h"

#include <cstring>

namespace twinray {
namespace {

// An accessor's elements lying side by side.
struct Elements {
    Bytes bytes;
    int component_type = 0;
    bool is_normalized = false;
};

std::size_t component_size(int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
        default: return 0;
    }
}

// The layout of an accessor in its buffer view.
struct Layout {
    int view = -1;
    std::size_t offset = 0, stride = 0, size = 0, count = 0;
};

// Copies elements of `layout.size` bytes, side by side, to `target`.
void copy_elements(const GltfFile& file, const Layout& layout, std::uint8_t* target, const std::string& object) {
    const std::span<const std::uint8_t> bytes = view_bytes(file, layout.view, object);
    if (layout.count == 0) return;
    const bool fits = layout.offset <= bytes.size() && layout.size <= bytes.size() - layout.offset &&
                      layout.count - 1 <= (bytes.size() - layout.offset - layout.size) / layout.stride;
    if (!fits)
        file.fail(object, ": ", layout.count, " elements of ", layout.size, " bytes, each ", layout.stride,
                  " bytes apart from byte ", layout.offset, ", leave bufferView ", layout.view, ", which has ",
                  bytes.size(), " bytes");
    for (std::size_t i = 0; i < layout.count; ++i)
        std::memcpy(target + i * layout.size, bytes.data() + layout.offset + i * layout.stride, layout.size);
}

// Vectors of vertices are at multiples of 4 bytes (glTF 2.0, 3.6.2.4). Some writers pad them and do not give the
// stride, without which they would be tightly packed: the view is then as long as the padded ones are.
bool is_padded(const tinygltf::Accessor& accessor, std::size_t element_size, std::size_t view_size) {
    const std::size_t padded = (element_size + 3) / 4 * 4;
    return accessor.type != TINYGLTF_TYPE_SCALAR && accessor.byteOffset == 0 && padded != element_size &&
           view_size / padded == accessor.count && view_size % padded == 0;
}

std::size_t stride_of(const GltfFile& file, const tinygltf::Accessor& accessor, std::size_t element_size,
                      const std::string& object) {
    const int view = accessor.bufferView;
    const std::size_t view_size = view_bytes(file, view, object).size();
    const std::size_t stride = file.model.bufferViews[std::size_t(view)].byteStride;
    if (stride == 0 && is_padded(accessor, element_size, view_size)) return (element_size + 3) / 4 * 4;
    if (stride != 0 && stride < element_size)
        file.fail(object, ": byteStride ", stride, " of bufferView ", view, " is less than an element's ", element_size,
                  " bytes");
    return stride == 0 ? element_size : stride;
}

bool is_unsigned(int component_type) {
    return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
           component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

std::uint32_t unsigned_at(const Bytes& bytes, std::size_t i, std::size_t size) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + i * size, size);  // little endian
    return value;
}

// Overwrites some elements, as accessor.sparse says.
void apply_sparse(const GltfFile& file, const tinygltf::Accessor& accessor, std::size_t element_size, Bytes& bytes,
                  const std::string& object) {
    const auto& sparse = accessor.sparse;
    const std::size_t index_size = component_size(sparse.indices.componentType);
    if (!is_unsigned(sparse.indices.componentType))
        file.fail(object, " sparse: indices have component type ", sparse.indices.componentType);
    if (sparse.count < 0 || std::size_t(sparse.count) > accessor.count)
        file.fail(object, " sparse: count ", sparse.count, " is not within 0 and the accessor's ", accessor.count);
    // The offsets are int in tinygltf 2.5, unsigned in later versions.
    if (std::int64_t(sparse.indices.byteOffset) < 0 || std::int64_t(sparse.values.byteOffset) < 0)
        file.fail(object, " sparse: negative byteOffset");

    const std::size_t count = std::size_t(sparse.count);
    Bytes indices(count * index_size), values(count * element_size);
    const auto read = [&](const auto& part, std::size_t size, Bytes& elements, const char* name) {
        copy_elements(file, {part.bufferView, std::size_t(part.byteOffset), size, size, count}, elements.data(),
                      object + name);
    };
    read(sparse.indices, index_size, indices, " sparse indices");
    read(sparse.values, element_size, values, " sparse values");
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t index = unsigned_at(indices, i, index_size);
        if (index >= accessor.count)
            file.fail(object, " sparse: index ", index, " at position ", i, " is not below the count ", accessor.count);
        std::memcpy(bytes.data() + index * element_size, values.data() + i * element_size, element_size);
    }
}

struct ElementType {
    int id;
    std::string name;
};
ElementType type_of(int components) {
    if (components == 1) return {TINYGLTF_TYPE_SCALAR, "SCALAR"};
    if (components == 16) return {TINYGLTF_TYPE_MAT4, "MAT4"};
    return {components, text("VEC", components)};
}

Elements gather(const GltfFile& file, int index, int components, const std::string& object) {
    const tinygltf::Accessor& accessor = file.entry(file.model.accessors, index, object, "accessor");
    if (const ElementType type = type_of(components); accessor.type != type.id)
        file.fail(object, ": accessor ", index, " is not of type ", type.name);
    const std::size_t size = component_size(accessor.componentType) * std::size_t(components);
    if (size == 0) file.fail(object, ": accessor ", index, " has component type ", accessor.componentType);

    Elements elements{{}, accessor.componentType, accessor.normalized};
    if (accessor.bufferView < 0) {
        if (accessor.count > file.zeros_left)
            file.fail(object, ": accessor ", index, " has no bufferView but count ", accessor.count,
                      ", and all of the file's that have none may have ", file.zeros_left, " more");
        file.zeros_left -= accessor.count;
        elements.bytes.resize(accessor.count * size);
    } else {
        const Layout layout{accessor.bufferView, accessor.byteOffset, stride_of(file, accessor, size, object), size,
                            accessor.count};
        if (accessor.count > view_bytes(file, accessor.bufferView, object).size())
            file.fail(object, ": accessor ", index, " has count ", accessor.count, ", more than bufferView ",
                      accessor.bufferView, " has bytes");
        elements.bytes.resize(accessor.count * size);
        copy_elements(file, layout, elements.bytes.data(), object);
    }
    if (accessor.sparse.isSparse) apply_sparse(file, accessor, size, elements.bytes, object);
    return elements;
}

// T's range maps to [0, 1] or, clamped, to [-1, 1].
template <class T>
std::vector<float> converted(const Elements& elements) {
    std::vector<float> floats(elements.bytes.size() / sizeof(T));
    for (std::size_t i = 0; i < floats.size(); ++i) {
        T value;
        std::memcpy(&value, elements.bytes.data() + i * sizeof(T), sizeof(T));
        floats[i] = static_cast<float>(value);
        if constexpr (std::is_integral_v<T>)
            if (elements.is_normalized)
                floats[i] = std::max(floats[i] / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
    }
    return floats;
}

}  // namespace

std::vector<float> read_floats(const GltfFile& file, int accessor, int components, const std::string& object) {
    const Elements elements = gather(file, accessor, components, object);
    std::vector<float> floats;
    const auto convert = [&](auto number) { floats = converted<decltype(number)>(elements); };
    if (!visit_component(std::uint64_t(elements.component_type), convert))
        file.fail(object, ": component type ", elements.component_type,
                  " is neither float nor an integer of 8 or 16 bits");
    return floats;
}

std::vector<uint> read_indices(const GltfFile& file, int accessor, const std::string& object) {
    const Elements elements = gather(file, accessor, 1, object);
    if (!is_unsigned(elements.component_type))
        file.fail(object, ": component type ", elements.component_type, " is not an unsigned integer");
    const std::size_t size = component_size(elements.component_type);
    std::vector<uint> indices(elements.bytes.size() / size);
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = unsigned_at(elements.bytes, i, size);
    return indices;
}

}  // namespace twinray
