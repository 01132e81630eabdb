#include "validation/reference/aimed_rays.h"
#include "validation/suite/case_run.h"

namespace twinray::suite {
BLOCK
}  // namespace twinray::suite
