// SPDX-License-Identifier: MIT
#include "viewer/picture/html_page.h"

#include <sstream>

#include "engine/core/files.h"
#include "engine/scene/png.h"

namespace twinray {
namespace {

// RFC 4648.
std::string base64_of(std::span<const std::byte> bytes) {
    static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string encoded;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        uint group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? std::to_integer<uint>(bytes[i + k]) : 0);
        for (std::size_t k = 0; k < 4; ++k) encoded += i + k > bytes.size() ? '=' : letters[group >> (18 - 6 * k) & 63];
    }
    return encoded;
}

std::string escaped(const std::string& words) {
    std::string safe;
    for (const char c : words) {
        if (c == '&')
            safe += "&amp;";
        else if (c == '<')
            safe += "&lt;";
        else if (c == '"')
            safe += "&quot;";
        else
            safe += c;
    }
    return safe;
}

}  // namespace

void write_html(const std::filesystem::path& file, const Raster& whole, const Page& page, const FacePicture& faces,
                std::span<const Note> notes) {
    const PagePlace corner = place_in(page);
    std::ostringstream out;
    out << "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\">"
        << "<meta name=\"viewport\" content=\"width=device-width\"><title>" << escaped(page.title) << "</title>\n"
        << "<style>body{font:15px sans-serif;margin:1em;color:#1e1e1e;background:#fff}svg{max-width:100%;height:auto}"
        << "circle{fill:transparent}circle:hover{stroke:#d55e00;stroke-width:2}"
        << "td{padding:0 1em 0 0}</style>\n"
        << "<svg viewBox=\"0 0 " << whole.width << ' ' << whole.height << "\" width=\"" << whole.width
        << "\" role=\"img\" aria-label=\"" << escaped(page.title + ". " + page.subtitle) << "\">"
        << "<image width=\"" << whole.width << "\" height=\"" << whole.height << "\" href=\"data:image/png;base64,"
        << base64_of(encode_png(whole.width, whole.height, whole.pixels)) << "\"/>\n";
    for (const Note& note : notes)
        if (const std::optional<vec2> at = place_of(faces, note.position); at && !note.detail.empty())
            out << "<circle cx=\"" << static_cast<float>(corner.x) + at->x << "\" cy=\""
                << static_cast<float>(corner.y) + at->y << "\" r=\"8\"><title>" << escaped(note.detail)
                << "</title></circle>\n";
    out << "</svg>\n<table>\n";
    for (const Note& note : notes)
        if (!note.detail.empty()) out << "<tr><td>" << escaped(note.detail) << "\n";
    out << "</table></html>\n";
    const std::string text = out.str();
    const std::span<const std::byte> bytes = std::as_bytes(std::span(text));
    write_file(file, std::span(&bytes, 1));
}

}  // namespace twinray
