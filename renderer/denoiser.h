// Removes the noise of a picture by Open Image Denoise 2, a library of another project that is looked for at run time.
#pragma once

#include <memory>
#include <vector>

#include <twinray/scene.h>

#include "renderer/shared.h"

namespace twinray::path_tracer {

class Denoiser {
  public:
    // Throws Error if the library is not found, saying who has it, or if it does not work here.
    Denoiser();
    ~Denoiser();

    // Returns the picture without its noise. surfaces: what each pixel's camera rays see first, `rays` of them; their
    // colours and normals tell edges from noise.
    HdrImage denoised(HdrImage picture, const std::vector<FirstSurface>& surfaces, uint rays) const;

  private:
    struct Library;
    std::unique_ptr<const Library> library_;
};

}  // namespace twinray::path_tracer
