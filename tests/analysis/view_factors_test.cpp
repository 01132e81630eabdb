// SPDX-License-Identifier: MIT
#include "engine/analysis/view_factors.h"

#include <cmath>

#include "engine/accel/scene_push.h"
#include "tests/accel/accel_fixture.h"
#include "tests/analysis/view_factor_scenes.h"

namespace twinray {
namespace {

using test::scene_of;

[[maybe_unused]] float factor(const ViewFactorRow& row, uint target) {
    for (const ViewFactor& entry : row.factors)
        if (entry.target == target) return entry.value;
    return 0;
}

class ViewFactorsOfAccels : public test::AccelTest {
  protected:
    std::vector<ViewFactorRow> rows(const Scene& scene, const ViewFactorOptions& options) {
        const auto accel = make_accel();
        push_scene(*accel, scene);
        const Faces faces(context(), scene);
        ViewFactors factors(*accel, faces, options);
        return factors.rows(0, factors.row_count());
    }
};
TWINRAY_OVER_EVERY_ACCEL(ViewFactorsOfAccels);

struct Known {
    std::string name;
    Scene scene;
    double value;  // from mesh 0 to mesh 1
};

// Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11 and C-14, evaluated with 30 digits.
std::vector<Known> known_factors() {
    return {{"parallel, distance 1", test::parallel_squares(1), 0.199824895698387383},
            {"parallel, distance 0.5", test::parallel_squares(0.5f), 0.415253283577146735},
            {"parallel, distance 2", test::parallel_squares(2), 0.0685895888185524478},
            {"parallel, distance 0.1", test::parallel_squares(0.1f), 0.826994522397256578},
            {"parallel, distance 0.01", test::parallel_squares(0.01f), 0.9804166029259733},
            {"perpendicular, 1 by 1", test::perpendicular_rectangles(1, 1), 0.200043776075403154},
            {"perpendicular, 2 by 1", test::perpendicular_rectangles(2, 1), 0.116426301397680944},
            {"perpendicular, 0.5 by 0.5", test::perpendicular_rectangles(0.5f, 0.5f), 0.240636006176961697}};
}

TEST_P(ViewFactorsOfAccels, ExploreCoverage) {
    for (const Known& known : known_factors()) {
        const auto accel = make_accel();
        push_scene(*accel, known.scene);
        const Faces faces(context(), known.scene);
        for (const Sequence sequence : {Sequence::sobol, Sequence::random}) {
            double previous = 0;
            for (const uint rays : {1024u, 4096u, 16384u, 65536u}) {
                int inside = 0;
                double squares = 0;
                const int seeds = 40;
                for (int seed = 0; seed < seeds; ++seed) {
                    ViewFactors factors(*accel, faces,
                                        {.grouping = FaceGrouping::mesh,
                                         .sequence = sequence,
                                         .rays = rays,
                                         .seed = static_cast<uint>(seed)});
                    const ViewFactorRow row = factors.rows(0, 1).front();
                    const ViewFactor& f = row.factors.front();
                    inside += f.low <= known.value && known.value <= f.high;
                    squares += (f.value - known.value) * (f.value - known.value);
                }
                const double rms = std::sqrt(squares / seeds);
                std::printf("%-26s %s %6u inside %d/%d rms %.2e slope %.2f\n", known.name.c_str(),
                            std::string(name_of(sequence)).c_str(), rays, inside, seeds, rms,
                            previous > 0 ? std::log(rms / previous) / std::log(4.0) : 0);
                previous = rms;
            }
        }
    }
}

}  // namespace
}  // namespace twinray
