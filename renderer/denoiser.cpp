#include "renderer/denoiser.h"

#include "engine/core/platform.h"
#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::fail;
namespace {

// The part of the library's C interface that is used, declared from its documentation. Objects are opaque pointers.
constexpr int device_of_cpu = 1, format_of_vec3 = 3;

using NewDevice = void*(int type);
using NewFilter = void*(void* device, const char* type);
using Act = void(void* object);
using SetBool = void(void* filter, const char* name, bool value);
using SetImage = void(void* filter, const char* name, void* pixels, int format, std::size_t width, std::size_t height,
                      std::size_t offset, std::size_t pixel_stride, std::size_t row_stride);
using LastError = int(void* device, const char** message);  // since the last call; 0: none

template <class Function>
Function* function_of(void* library, const char* name) {
    void* const symbol = platform::symbol_of(library, name);
    if (!symbol) fail(platform::image_denoiser.library, ": not Open Image Denoise 2, because it has no ", name);
    return reinterpret_cast<Function*>(symbol);
}

// It is never closed: threads of it may run until the process ends.
void* open_denoiser() {
    const auto [library, hint] = platform::image_denoiser;
    void* const opened = platform::open_library(library);
    if (!opened) fail("no Open Image Denoise: ", library, " cannot be opened (", hint, ")");
    return opened;
}

std::vector<vec3> means_of(const std::vector<FirstSurface>& surfaces, vec3 FirstSurface::*sum, uint rays) {
    std::vector<vec3> means;
    means.reserve(surfaces.size());
    for (const FirstSurface& surface : surfaces) means.push_back(surface.*sum / static_cast<float>(rays));
    return means;
}

}  // namespace

struct Denoiser::Library {
    void* const handle = open_denoiser();
    NewDevice* new_device = function_of<NewDevice>(handle, "oidnNewDevice");
    Act* commit_device = function_of<Act>(handle, "oidnCommitDevice");
    Act* release_device = function_of<Act>(handle, "oidnReleaseDevice");
    LastError* last_error = function_of<LastError>(handle, "oidnGetDeviceError");
    NewFilter* new_filter = function_of<NewFilter>(handle, "oidnNewFilter");
    SetBool* set_bool = function_of<SetBool>(handle, "oidnSetFilterBool");
    SetImage* set_image = function_of<SetImage>(handle, "oidnSetSharedFilterImage");
    Act* commit_filter = function_of<Act>(handle, "oidnCommitFilter");
    Act* execute_filter = function_of<Act>(handle, "oidnExecuteFilter");
    Act* release_filter = function_of<Act>(handle, "oidnReleaseFilter");
    // The processor reads pictures where they are; a GPU would need copies of them.
    std::unique_ptr<void, Act*> device{new_device(device_of_cpu), release_device};

    void check() const {
        const char* message = nullptr;
        if (last_error(device.get(), &message)) fail(platform::image_denoiser.library, ": ", message);
    }
};

Denoiser::Denoiser() {
    auto library = std::make_unique<Library>();
    if (library->device) library->commit_device(library->device.get());
    library->check();
    library_ = std::move(library);
}

Denoiser::~Denoiser() = default;

HdrImage Denoiser::denoised(HdrImage picture, const std::vector<FirstSurface>& surfaces, uint rays) const {
    std::vector<vec3> albedo = means_of(surfaces, &FirstSurface::albedo, rays),
                      normal = means_of(surfaces, &FirstSurface::normal, rays), output(picture.rgb.size());
    const std::unique_ptr<void, Act*> filter(library_->new_filter(library_->device.get(), "RT"),
                                             library_->release_filter);
    library_->check();
    const auto set = [&](const char* name, std::vector<vec3>& pixels) {
        library_->set_image(filter.get(), name, pixels.data(), format_of_vec3, picture.width, picture.height, 0,
                            sizeof(vec3), sizeof(vec3) * picture.width);
    };
    set("color", picture.rgb);
    set("albedo", albedo);
    set("normal", normal);
    set("output", output);
    library_->set_bool(filter.get(), "hdr", true);
    library_->commit_filter(filter.get());
    library_->execute_filter(filter.get());
    library_->check();
    picture.rgb = std::move(output);
    return picture;
}

}  // namespace twinray::path_tracer
