#include "validation/reference/aimed_rays.h"
#include "report/suite/case_run.h"

namespace twinray::suite {
BLOCK
}  // namespace twinray::suite
