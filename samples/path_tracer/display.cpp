// SPDX-License-Identifier: MIT
#include "samples/path_tracer/display.h"

#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <memory>

#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::fail;
namespace {

constexpr char default_port[] = "14158";
constexpr char update_image = 3, create_image = 4;
constexpr std::array channels = {"R", "G", "B"};

struct Address {
    std::string host, port;
};

Address address_of(const std::string& server) {
    const std::size_t colon = server.rfind(':');
    if (colon == std::string::npos) return {server, default_port};
    return {server.substr(0, colon), server.substr(colon + 1)};
}

// -1: nobody listens there.
int connected_socket(const Address& address) {
    addrinfo hints{}, *found = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    if (getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found) != 0) return -1;
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> all(found, &freeaddrinfo);
    for (const addrinfo* one = all.get(); one; one = one->ai_next) {
        const int result = socket(one->ai_family, one->ai_socktype, one->ai_protocol);
        if (result < 0) continue;
        // A viewer that does not read for so long counts as gone.
        const timeval patience{.tv_sec = 2, .tv_usec = 0};
        setsockopt(result, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        if (connect(result, one->ai_addr, one->ai_addrlen) == 0) return result;
        close(result);
    }
    return -1;
}

// Little-endian, as the protocol is and the machines that this runs on are.
template <class T>
void put(std::string& payload, const T& value) {
    payload.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put_text(std::string& payload, const std::string& value) { payload.append(value.c_str(), value.size() + 1); }

std::string header(char kind, const std::string& name) {
    std::string payload(1, kind);
    payload += '\0';  // the viewer need not come to the front
    put_text(payload, name);
    return payload;
}

}  // namespace

Display::Display(const std::string& server, const std::string& name, uint width, uint height)
    : name_(name), socket_(connected_socket(address_of(server))) {
    if (socket_ < 0) fail("--display-server ", server, ": nobody listens there; it must be HOST or HOST:PORT");
    std::string payload = header(create_image, name_);
    put(payload, width);
    put(payload, height);
    put(payload, static_cast<uint>(channels.size()));
    for (const char* channel : channels) put_text(payload, channel);
    send_packet(payload);
}

Display::~Display() {
    if (socket_ >= 0) close(socket_);
}

bool Display::show(const HdrImage& picture) {
    for (std::size_t channel = 0; channel < channels.size(); ++channel) {
        std::string payload = header(update_image, name_);
        put_text(payload, channels[channel]);
        for (const uint value : {0u, 0u, picture.width, picture.height}) put(payload, value);
        for (const vec3& rgb : picture.rgb) put(payload, rgb[static_cast<int>(channel)]);
        if (!send_packet(payload)) return false;
    }
    return true;
}

bool Display::send_packet(const std::string& payload) {
    std::string packet;
    put(packet, static_cast<uint>(payload.size() + sizeof(uint)));
    packet += payload;
    for (std::size_t sent = 0; sent < packet.size();) {
        const ssize_t count = send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL);
        if (count <= 0) return false;
        sent += static_cast<std::size_t>(count);
    }
    return true;
}

}  // namespace twinray::path_tracer
