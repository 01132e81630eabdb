// SPDX-License-Identifier: MIT
// Pictures in a viewer of images while they are rendered.
#pragma once

#include <string>

#include <twinray/scene.h>

namespace twinray::path_tracer {

// A picture in a viewer that shows what comes over a TCP connection, as tev does: its protocol's packets CreateImage
// and, for each channel, UpdateImage (github.com/Tom94/tev), as pbrt-v4 sends them.
class Display {
  public:
    // server: HOST:PORT, or HOST alone for port 14158. Throws Error where nobody listens there.
    Display(const std::string& server, const std::string& name, uint width, uint height);
    ~Display();
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;

    // False from when the viewer has gone on.
    bool show(const HdrImage& picture);

  private:
    bool send_packet(const std::string& payload);

    std::string name_;
    int socket_ = -1;
};

}  // namespace twinray::path_tracer
