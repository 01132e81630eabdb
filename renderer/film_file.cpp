#include "renderer/film_file.h"

#include <bit>
#include <cstring>

#include "samples/support/files.h"
#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::crc32_of;
using samples::fail;
using samples::lower_suffix;
using samples::read_file;
using samples::write_file;
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr char magic[16] = "twinray film 1\n";

struct FilmHeader {
    char magic[16];
    uint width, height, block_size, text_bytes, word_count, text_sum;
};
static_assert(sizeof(FilmHeader) == 40);

Configuration configuration_of(const std::string& lines) {
    Configuration configuration;
    std::istringstream in(lines);
    for (std::string line; std::getline(in, line);)
        if (const std::size_t colon = line.find(": "); colon != std::string::npos)
            configuration.emplace_back(line.substr(0, colon), line.substr(colon + 2));
    return configuration;
}

// Takes values off the front of the file.
class Reader {
  public:
    explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}
    void take(void* to, std::size_t size) {
        if (size) std::memcpy(to, bytes_.data(), size);
        bytes_ = bytes_.subspan(size);
    }

  private:
    std::span<const std::byte> bytes_;
};

// Needs a film that has no more pixels than a file could have bytes, so that nothing overflows.
std::uint64_t size_of(const FilmHeader& header) {
    return sizeof header + std::uint64_t{header.text_bytes} + std::uint64_t{header.word_count} * sizeof(uint) +
           std::uint64_t{header.width} * header.height * sizeof(FilmPixel) + sizeof(uint);
}

void check(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    constexpr std::string_view kind = "twinray film ";
    if (bytes.size() < sizeof(FilmHeader) || std::memcmp(bytes.data(), kind.data(), kind.size()) != 0)
        fail("'", file.string(), "': not a film of path_tracer");
    if (std::memcmp(bytes.data(), magic, sizeof magic) != 0)
        fail("'", file.string(), "': a film of another version of path_tracer; this one reads version 1");
    FilmHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    const std::uint64_t pixels = std::uint64_t{header.width} * header.height;
    if (pixels > bytes.size() || bytes.size() != size_of(header))
        fail("'", file.string(), "': ", bytes.size(), " bytes are not those of a film of ", header.width, " x ",
             header.height, " pixels; it was cut short or damaged");
    uint sum = 0;
    std::memcpy(&sum, bytes.data() + bytes.size() - sizeof sum, sizeof sum);
    if (sum != crc32_of(bytes.first(bytes.size() - sizeof sum)))
        fail("'", file.string(), "': damaged (its checksum does not match)");
}

}  // namespace

void save_film(const std::filesystem::path& file, const Film& film) {
    const std::string lines = text_of(film.configuration);
    FilmHeader header{{},
                      film.width,
                      film.height,
                      film.block_size,
                      static_cast<uint>(lines.size()),
                      static_cast<uint>(film.blocks.words().size()),
                      crc32_of(std::as_bytes(std::span(lines)))};
    std::memcpy(header.magic, magic, sizeof magic);
    std::vector<std::span<const std::byte>> parts = {
        std::as_bytes(std::span(&header, 1)), std::as_bytes(std::span(lines)),
        std::as_bytes(std::span(film.blocks.words())), std::as_bytes(std::span(film.pixels))};
    uint sum = 0;
    for (const auto& part : parts) sum = crc32_of(part, sum);
    parts.push_back(std::as_bytes(std::span(&sum, 1)));
    write_file(file, parts);
}

Film load_film(const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = read_file(file);
    check(file, bytes);
    Reader reader(bytes);
    FilmHeader header;
    reader.take(&header, sizeof header);
    std::string lines(header.text_bytes, ' ');
    reader.take(lines.data(), lines.size());
    std::vector<uint> words(header.word_count);
    reader.take(words.data(), words.size() * sizeof(uint));
    Film film = Film::empty(header.width, header.height, header.block_size, configuration_of(lines));
    reader.take(film.pixels.data(), film.pixels.size() * sizeof(FilmPixel));
    film.blocks = BlockSet(std::move(words));
    return film;
}

bool is_film_file(const std::filesystem::path& file) { return lower_suffix(file) == ".film"; }

}  // namespace twinray::path_tracer
