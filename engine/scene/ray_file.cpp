#include "engine/scene/ray_file.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iomanip>

#include "engine/core/error.h"
#include "engine/scene/importers/words.h"

namespace twinray {
namespace {

static_assert(std::endian::native == std::endian::little, "ray and hit files are little-endian");

constexpr std::size_t numbers_a_ray = sizeof(Ray) / sizeof(float);

// Returns the whole file, as many T as fit into it.
template <class T>
std::vector<T> read_all(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    if (!in || std::filesystem::is_directory(file)) fail("rays file '", file.string(), "' cannot be opened");
    const auto bytes = static_cast<std::uint64_t>(in.tellg());
    if (bytes % sizeof(T) != 0)
        fail("rays file '", file.string(), "': ", bytes, " bytes is not a multiple of ", sizeof(T),
             ", the size of a ray; rays as text belong in a .csv or .txt file");
    std::vector<T> values(bytes / sizeof(T));
    in.seekg(0);
    if (!in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(bytes)))
        fail("rays file '", file.string(), "' cannot be read");
    return values;
}

// A .npy file (numpy.lib.format): 6 bytes of magic, 2 of version, the length of the header in 2 bytes or from version 2
// on 4, the header, and the array.
class Npy {
  public:
    explicit Npy(const std::filesystem::path& file) : file_(file), bytes_(read_all<char>(file)) {
        const std::string_view all(bytes_.data(), bytes_.size());
        if (!all.starts_with("\x93NUMPY") || all.size() < 12) refuse("it is not a NumPy array");
        const std::size_t start = all[6] > 1 ? 12 : 10;
        std::size_t length = 0;
        for (std::size_t i = start; i-- > 8;) length = length << 8 | static_cast<std::uint8_t>(all[i]);
        if (length > all.size() - start) refuse("its header is cut off");
        header_ = all.substr(start, length);
        data_ = all.substr(start + length);
    }

    std::vector<Ray> rays(const dvec3& origin) const {
        if (!value_of("'fortran_order':").starts_with("False")) refuse("its order is Fortran's, not C's");
        const std::string_view type = value_of("'descr':");
        if (type.starts_with("'<f8'")) return rays_of<double>(origin);
        if (type.starts_with("'<f4'")) return rays_of<float>(origin);
        refuse("its numbers are neither float64 nor float32, little endian");
    }

  private:
    [[noreturn]] void refuse(const char* why) const { fail("rays file '", file_.string(), "': ", why); }

    std::string_view value_of(std::string_view key) const {
        const std::size_t at = header_.find(key);
        if (at == std::string_view::npos) refuse("its header is not that of a NumPy array");
        const std::string_view rest = header_.substr(at + key.size());
        return rest.substr(std::min(rest.find_first_not_of(' '), rest.size()));
    }

    template <class T>
    std::vector<Ray> rays_of(const dvec3& origin) const {
        using Row = std::array<T, numbers_a_ray>;
        std::vector<Ray> rays(data_.size() / sizeof(Row));
        if (!value_of("'shape':").starts_with(text("(", rays.size(), ", ", numbers_a_ray, ")")) ||
            data_.size() % sizeof(Row) != 0)
            refuse("its shape is not (N, 8), or it does not hold as many numbers");
        for (std::size_t i = 0; i < rays.size(); ++i) {
            Row row;
            std::memcpy(row.data(), data_.data() + i * sizeof row, sizeof row);
            rays[i] = {vec3(dvec3(row[0], row[1], row[2]) - origin), static_cast<float>(row[3]),
                       vec3(row[4], row[5], row[6]), static_cast<float>(row[7])};
        }
        return rays;
    }

    const std::filesystem::path& file_;
    std::vector<char> bytes_;
    std::string_view header_, data_;
};

std::vector<Ray> read_lines(const std::filesystem::path& file, const dvec3& origin) {
    std::vector<Ray> rays;
    read_number_lines(file, "rays file", "x,y,z,dx,dy,dz", [&](std::span<const double> v, std::size_t) {
        rays.push_back({vec3(dvec3(v[0], v[1], v[2]) - origin), 0, vec3(v[3], v[4], v[5]), INFINITY});
    });
    return rays;
}

// numpy.lib.format, version 1.0: the header ends at a multiple of 64 bytes.
std::string npy_header_of_hits(std::size_t count) {
    std::string header = text(
        "{'descr': [('hit', '<u4'), ('t', '<f4'), ('primitive_index', '<u4'), ('custom_index', '<u4'), ('u', '<f4'), "
        "('v', '<f4'), ('instance_index', '<u4'), ('flags', '<u4')], 'fortran_order': False, 'shape': (",
        count, ",), }");
    constexpr std::size_t before = 10, alignment = 64;
    header.append(alignment - (before + header.size() + 1) % alignment, ' ');
    header += '\n';
    const auto length = static_cast<std::uint16_t>(header.size());
    return std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(length & 255) + static_cast<char>(length >> 8) +
           header;
}

void write_lines(std::ostream& out, const std::vector<Hit>& hits) {
    out << "hit,t,primitive_index,custom_index,u,v,instance_index\n" << std::setprecision(9);
    const float zero = 0;  // -0 plus it is 0
    for (const Hit& hit : hits)
        out << hit.hit << ',' << hit.t << ',' << hit.primitive_index << ',' << hit.custom_index << ',' << hit.u + zero
            << ',' << hit.v + zero << ',' << hit.instance_index << '\n';
}

}  // namespace

std::vector<Ray> read_rays(const std::filesystem::path& file, const dvec3& origin) {
    if (lower_suffix(file) == ".npy") return Npy(file).rays(origin);
    if (const std::string suffix = lower_suffix(file); suffix == ".csv" || suffix == ".txt")
        return read_lines(file, origin);
    std::vector<Ray> rays = read_all<Ray>(file);
    for (Ray& ray : rays) ray.origin = vec3(dvec3(ray.origin) - origin);
    return rays;
}

void write_hits(const std::filesystem::path& file, const std::vector<Hit>& hits) {
    std::ofstream out(file, std::ios::binary);
    const std::string suffix = lower_suffix(file);
    if (suffix == ".npy") out << npy_header_of_hits(hits.size());
    if (suffix == ".csv")
        write_lines(out, hits);
    else
        out.write(reinterpret_cast<const char*>(hits.data()), static_cast<std::streamsize>(hits.size() * sizeof(Hit)));
    if (!out.flush()) fail("hits file '", file.string(), "' cannot be written");
}

}  // namespace twinray
