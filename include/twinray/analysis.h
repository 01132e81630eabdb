// SPDX-License-Identifier: MIT
// What twinray computes of scenes by rays: view factors and radiosity, the light of sun and sky, centroids.
//
// - A face is a triangle of an instance. Faces are numbered by instance, in the order of Scene::instances, then by
//   triangle; those that no ray can meet keep their number and have the area 0.
// - Lengths and areas are the scene's own, in world space, in float64 from float32 vertices and transforms.
// - Intervals are confidence intervals of 95 % and hold whatever the scene.
// - An analysis takes an accelerator as it is, wherever its instances and vertices were moved, and Faces made of it, or
//   an accelerator that push_scene() has filled and the scene. It syncs the accelerator. The same scene and options
//   give the same result on one device.
// - Options out of range, an accelerator or faces of another scene and failures of the device throw Error, which names
//   what, the value and the limit.
// - Contexts, accelerators and Faces must outlive what was made with them; an object is used by one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <twinray/abstract_accel.h>
#include <twinray/scene.h>

namespace twinray {

// From the lowest to the highest value, both included.
struct Interval {
    double low = 0, high = 0;

    bool operator==(const Interval&) const = default;
};

// A value that rays told, and what is known of its error.
struct Estimate {
    double value = 0;
    Interval interval_95;

    double half_width() const { return (interval_95.high - interval_95.low) / 2; }  // of the interval
};

// Is called with how many more rays are done; by exchanges_of_pairs() with groups.
using ProgressCallback = std::function<void(std::uint64_t)>;

// Faces ---------------------------------------------------------------------------------------------------------------

// A triangle of an instance; both count from 0.
struct Face {
    uint instance, primitive;
};

// Which sides of faces radiate or receive; either one stops rays.
enum class Sides : std::uint8_t {
    front,  // on which the vertices turn counter-clockwise in object space
    both,
};
// As options spell it.
constexpr std::string_view name_of(Sides sides) { return sides == Sides::front ? "front" : "both"; }

// By what faces are put together to groups.
enum class FaceGrouping : std::uint8_t {
    face,
    mesh,      // of an accelerator the handle, by its place in AbstractAccel::handles()
    instance,  // by Hit::instance_index
    material,  // by its index in the scene; of an accelerator by Faces::metadata()
    custom,    // Faces::set_custom_groups()
};
std::string_view name_of(FaceGrouping grouping);  // as options spell it

// As long as the face's area in world space, perpendicular to its front; 0 of faces that no ray can meet.
dvec3 area_vector(const Scene& scene, Face face);
// Of meshes, instances and materials of triangles: of all that tells the faces of one scene from those of another.
std::uint32_t checksum_of(const Scene& scene);

// The faces of a scene as they were when this was made, with a copy of their triangles on the device.
class Faces {
  public:
    // Throws Error above 2^32 - 16 faces, and for a coordinate above 2^124 in world space: distances would overflow.
    Faces(Context& context, const Scene& scene);
    // Of what an accelerator holds after a sync: see scene_of().
    explicit Faces(AbstractAccel& accel);
    Faces(Faces&&) noexcept;
    Faces& operator=(Faces&&) noexcept;
    ~Faces();
    std::size_t count() const;                                // of faces, those without area too
    Face operator[](std::size_t face) const;                  // by its number
    const std::vector<double>& areas() const;                 // by face
    const std::vector<std::size_t>& triangle_counts() const;  // by instance
    std::uint64_t bytes() const;                              // of device memory
    // Of Faces of an accelerator, else Error: what it held then, whether it has been synced with edits since, and the
    // face_metadata of its meshes, ascending, each once (0 for those without), which number groups by material.
    const Scene& scene() const;
    // No edit of it was synced since.
    bool is_current(AbstractAccel& accel) const;
    // By the group's number.
    const std::vector<uint>& metadata() const;

    // One for each face, below their count. Throws Error, and changes nothing, for any other count or number.
    void set_custom_groups(std::vector<uint> groups);
    // The group of each face: its number, or the index of its mesh, instance or material in the scene, or what was set.
    // Throws Error for custom groups before they are set.
    std::vector<uint> groups(FaceGrouping grouping) const;
    std::size_t group_count(FaceGrouping grouping) const;                 // groups without a face included
    std::vector<std::vector<uint>> members(FaceGrouping grouping) const;  // of each, those with an area, ascending
    // Sums over members.
    std::vector<double> areas_of(const std::vector<std::vector<uint>>& groups) const;

    struct State;  // internal
    const State& state() const { return *state_; }

  private:
    std::unique_ptr<State> state_;
};

// View factors --------------------------------------------------------------------------------------------------------
// F_ij is the fraction of the diffuse radiation of group i that meets group j directly (Howell, "A catalog of radiation
// configuration factors"), A_i F_ij = A_j F_ji their exchange.

// Of samples: Owen-scrambled Sobol points (PBRT-v4, 8.7), or random ones.
enum class Sequence : std::uint8_t { sobol, random };
// As options spell it.
constexpr std::string_view name_of(Sequence sequence) { return sequence == Sequence::sobol ? "sobol" : "random"; }

// What a row of the matrix is computed by.
struct ViewFactorOptions {
    FaceGrouping grouping = FaceGrouping::face;
    // `front`: faces radiate from their fronts, and what meets a back side counts as neither face nor open. `both`:
    // half of the rays leave each side.
    Sides sides = Sides::front;
    Sequence sequence = Sequence::sobol;
    // Of a row, 1 to 2^31, rounded up to multiples of 64; the most where target_error is set.
    std::uint64_t rays = 1 << 14;
    // Above 0. A row is done when no interval is longer than twice this; tried at each doubling of rays from 1024 on.
    std::optional<double> target_error = {};
    uint seed = 1;
};

// What told an exchange.
enum class PairEstimator : uint {
    automatic,  // contours for what nothing can come between, areas for what is far for its size, else hits
    hits,       // what the rays of a row meet
    area,       // rays between points of both faces (area-to-area sampling)
    contour,    // integrals along both contours (Sparrow 1963), by Gauss-Kronrod quadrature: not an estimate
};
inline constexpr std::array all_pair_estimators = {PairEstimator::automatic, PairEstimator::hits, PairEstimator::area,
                                                   PairEstimator::contour};
// As options spell it.
constexpr std::string_view name_of(PairEstimator estimator) {
    constexpr std::array<std::string_view, 4> names = {"auto", "hits", "area", "contour"};
    return names[static_cast<std::size_t>(estimator)];
}

// An entry of the matrix.
struct ViewFactor {
    uint target = 0;                     // group
    float value = 0, low = 0, high = 0;  // and its interval
    PairEstimator by = PairEstimator::hits;
};

// A row of the matrix: where the radiation of one group goes.
struct ViewFactorRow {
    uint group = 0;
    std::uint64_t rays = 0;  // none where it has no area
    // Ascending by target, without those that are 0, but for areas all of whose rays were blocked: their interval is
    // what is known of them.
    std::vector<ViewFactor> factors;
    std::uint64_t hits = 0;  // rays that met a face
    Estimate open, back;     // fractions that met nothing, or a back side
};

// A_i F_ij of groups i <= j, with its interval.
struct KnownExchange {
    uint i, j;
    double flow, low, high;
    PairEstimator by;  // area where anything of it is by areas
};

// What exchanges_of_pairs() found.
struct PairExchanges {
    std::vector<KnownExchange> known;  // ascending by i, then j
    std::uint64_t left_to_hits = 0;    // pairs of groups that may see each other
    std::uint64_t rays = 0;            // between points of faces
};

inline constexpr std::size_t most_paired_faces = 1024;  // with an area: their pairs are looked at one by one

// What contours and areas tell of a scene, for ViewFactors to use instead of hits. The pairs of areas share as many
// rays as a row has, but get at least 64 for two faces, and more where their intervals would be wider than those of
// hits; with target_error, their rays are doubled until the interval of both view factors is short enough. Throws Error
// for more than most_paired_faces, and naming the faces where the estimator that is asked for does not fit a pair.
PairExchanges exchanges_of_pairs(AbstractAccel& accel, const Scene& scene, const Faces& faces,
                                 const ViewFactorOptions& options, PairEstimator estimator,
                                 const ProgressCallback& progress = {});

// Of an accelerator and its Faces.
PairExchanges exchanges_of_pairs(AbstractAccel& accel, const Faces& faces, const ViewFactorOptions& options,
                                 PairEstimator estimator, const ProgressCallback& progress = {});

// The matrix of view factors, row by row, by rays that leave each face uniformly by area and by cosine.
class ViewFactors {
  public:
    // `known` replaces what rays met; rows that contours fill get 1024 rays at most.
    ViewFactors(AbstractAccel& accel, const Faces& faces, const ViewFactorOptions& options,
                std::span<const KnownExchange> known = {});
    // Faces must outlive it.
    ViewFactors(AbstractAccel&, const Faces&&, const ViewFactorOptions&, std::span<const KnownExchange> = {}) = delete;
    ~ViewFactors();

    std::size_t row_count() const;             // as many as groups
    const std::vector<double>& areas() const;  // of groups
    std::size_t batch_size() const;            // how many rows are best computed at a time
    // Rows [first, last), in order. What a row holds depends on the options and the scene alone.
    std::vector<ViewFactorRow> rows(std::size_t first, std::size_t last);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// How far the estimates of a whole matrix are from what view factors obey. `rows`: all, in order; areas: of groups.
struct ViewFactorResiduals {
    double reciprocity = 0;         // largest |A_i F_ij - A_j F_ji| over the largest area
    double reciprocity_scaled = 0;  // the same, over the smaller area of the two
    double reciprocity_sigma =
        0;               // the same in its standard errors, of pairs with at least 10 rays expected either way
    double closure = 0;  // largest |1 - sum_j F_ij - open - back| of rows with an area
};
// Of a whole matrix.
ViewFactorResiduals residuals_of(const std::vector<ViewFactorRow>& rows, const std::vector<double>& areas);

// The least change, in squares weighted by inverse binomial variances, after which A_i F_ij = A_j F_ji but for rounding
// to float32, and rows add up to 1 with `open` and `back`, which change, too (Lawson, "Improving the accuracy of view
// factors by least squares smoothing"). Entries of which one direction was seen are completed; intervals move with
// their values and keep their widths, which is more than they need. Throws Error where the solver does not converge.
void project(std::vector<ViewFactorRow>& rows, const std::vector<double>& areas);

// Finished rows on disk, so that work goes on where it was killed: appended in order and flushed, each with a checksum.
class RowFile {
  public:
    // `configuration` tells of what the rows are; it must be the same in all runs that share the file.
    RowFile(std::filesystem::path file, const std::string& configuration);
    ~RowFile();

    // The rows that are there, the first ones in order without a gap; cuts off what follows them. None where there is
    // no such file. Throws Error where it is of another configuration.
    std::vector<ViewFactorRow> load();
    void create();  // begins anew, without rows
    // After load() or create(). Throws Error naming the file where it cannot be written.
    void append(std::span<const ViewFactorRow> rows);
    void remove();  // the file, if it is there

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Diffuse light or heat between groups: B = E + rho F B, B being what leaves a group by area, E what it emits and rho
// what it reflects of what arrives.
struct Radiosity {
    std::vector<double> values;    // B, in the unit of emission
    std::vector<double> incident;  // F B: what arrives by area
    double relative_residual = 0;  // |E + rho F B - B| over |B|, largest entries
    double amplification = 0;      // largest row sum of (I - rho F)^-1: 1 / (1 - rho) in a closed room of one rho
    double forward_error = 0;      // bound of the largest |B - B_exact| over the largest |B|, for this F
    // Half the interval of B by that of F, to first order, as if all rows erred the same way: an upper bound.
    std::vector<double> sampling;
    int iterations = 0;  // of the solver, for B
};
// `rows`: of a whole matrix, in order; emission, finite, and reflectance, in [0, 1], have one entry a row. Rows without
// rays keep B = E. Solved by BiCGSTAB in float64 and refined until the residual is below `tolerance`; throws Error
// where it does not get there, as for a closed room that reflects everything, and for wrong sizes or values.
Radiosity solve_radiosity(const std::vector<ViewFactorRow>& rows, std::span<const double> emission,
                          std::span<const double> reflectance, double tolerance = 1e-13);

// Light ---------------------------------------------------------------------------------------------------------------

// Where in their cells rays of a grid pass.
enum class GridPoints : std::uint8_t {
    random,   // one in each cell, uniform and independent: means are unbiased and have intervals
    centers,  // of the cells: the same rays for every seed
};

// Parallel rays through the cells of a grid in front of the scene, which covers all that is seen of it.
struct RayGridDesc {
    dvec3 direction = dvec3(0, 0, -1);  // of the rays, in world space; finite, of any length but 0
    uint side = 1000;                   // side * side rays; 1 to 65535
    GridPoints points = GridPoints::random;
    std::uint64_t seed = 1;
};

// What illuminate() computes, and how.
struct IlluminationDesc {
    RayGridDesc grid;
    Sides sides = Sides::both;
    FaceGrouping by = FaceGrouping::face;
    ProgressCallback progress = {};
};

// Areas are projected: as seen along the light, what it would give to a plane across it. Divided by the cosine that is
// area of the face itself.
struct LitArea {
    std::uint64_t hits = 0;   // rays whose closest hit it is; times cell_area an unbiased area with random points
    double area = 0;          // that, but no more than `unobstructed`
    Interval interval;        // of `area`; with centers of cells all that is possible
    double unobstructed = 0;  // the area if nothing else were there
    double surface = 0;       // of the faces themselves, in world space

    // How much of what is turned to the light is lit; 0 where nothing is.
    double fraction() const { return unobstructed > 0 ? area / unobstructed : 0; }
    // Mean over the faces, in units of what light brings to a plane across it.
    double irradiance() const { return surface > 0 ? area / surface : 0; }
};

// What illuminate() found: an entry a group.
struct Illumination {
    std::vector<LitArea> groups;
    LitArea total;  // hits of all groups; as a group of its own
    std::uint64_t ray_count = 0;
    double cell_area = 0;
};
// What parallel light reaches of a scene. Intervals: hits of random points are independent, and how often neighbours
// differ bounds their variance. Throws Error for scenes too large for float32 rays to start in front of, too.
Illumination illuminate(AbstractAccel& accel, const Scene& scene, const Faces& faces, const IlluminationDesc& desc);
Illumination illuminate(AbstractAccel& accel, const Faces& faces, const IlluminationDesc& desc);

// How sky_light() and sun_hours() sample.
struct SkyRaysDesc {
    uint samples = 256;  // rays of each face; 1 to 2^20
    Sides sides = Sides::both;
    std::uint64_t seed = 1;
    ProgressCallback progress = {};
};

// What a face received.
struct Received {
    std::uint64_t free_rays = 0;  // that got out of the scene
    double value = 0;
    Interval interval;
};

// An entry a face.
struct SkyLight {
    std::vector<Received> faces;
    std::uint64_t ray_count = 0;
};

// What light of the same radiance from everywhere above the horizon brings to each face, mean over its points, in
// units of what it brings to an unobstructed horizontal plane: of its front the sky view factor, which is (1 + cos) / 2
// for an unobstructed face tilted by an angle, and never more; of both sides together 1 for any such face. `zenith`:
// finite, of any length but 0.
SkyLight sky_light(AbstractAccel& accel, const Scene& scene, const Faces& faces, dvec3 zenith, const SkyRaysDesc& desc);
SkyLight sky_light(AbstractAccel& accel, const Faces& faces, dvec3 zenith, const SkyRaysDesc& desc);

// Where the sun stands, and for how long.
struct SunPosition {
    dvec3 direction;   // in which its rays go; finite, of any length but 0
    double hours = 1;  // for which it stays; finite and not negative
};
// Hours for which a point of a face is lit, mean over the face: for each position `desc.samples` rays a face, from
// stratified points. A side lit at a grazing angle counts like any other.
SkyLight sun_hours(AbstractAccel& accel, const Scene& scene, const Faces& faces, std::span<const SunPosition> positions,
                   const SkyRaysDesc& desc);
SkyLight sun_hours(AbstractAccel& accel, const Faces& faces, std::span<const SunPosition> positions,
                   const SkyRaysDesc& desc);

// Patches of the sky by their middles, as Radiance numbers them: by row from the horizon up, in a row from north by
// east, the zenith's last; z is up, y north. Tregenza, "Subdivision of the sky hemisphere for luminance measurements"
// (1987), and Reinhart's division of each into 2 x 2 or 4 x 4.
inline constexpr std::array<std::string_view, 3> sky_names = {"tregenza145", "reinhart577", "reinhart2305"};
// A part of the sky, by its middle.
struct SkyPatch {
    dvec3 direction;         // unit
    double solid_angle = 0;  // steradians; 2 pi in all
};
// By one of sky_names; throws Error for another name.
std::vector<SkyPatch> sky_patches(std::string_view name);

// Options of visibility().
struct VisibilityDesc {
    float t_near = 0;  // in lengths of a direction: hits before it do not count, for points on the scene itself
    ProgressCallback progress = {};
};
// Of each point along each direction, of any length: 1 where nothing lies on the ray, else 0; rows are points. With
// normals, a direction that does not leave the side of the point's normal gives 0, and rays begin off the point by what
// rounding may have moved a surface there. Throws Error for another count of normals, and more than 2^20 directions.
std::vector<std::uint8_t> visibility(AbstractAccel& accel, std::span<const vec3> points,
                                     std::span<const vec3> directions, std::span<const vec3> normals = {},
                                     const VisibilityDesc& desc = {});

// What centroid() computes, and how.
struct CentroidDesc {
    RayGridDesc grid;
    bool keeps_points = false;
    ProgressCallback progress = {};
};

// What centroid() found.
struct Centroid {
    std::uint64_t ray_count = 0;
    std::uint64_t point_count = 0;  // rays that hit
    std::optional<dvec3> mean;      // of the closest points of all rays; none where nothing is hit
    // Of `mean`, by axis, and on average not below; only with random points, for centers are not independent.
    std::optional<dvec3> standard_error;
    std::vector<dvec3> points;  // in the order of the rays; empty unless CentroidDesc::keeps_points
};
// The mean of what is seen of a scene along a direction. Throws Error as illuminate() does.
Centroid centroid(AbstractAccel& accel, const Scene& scene, const CentroidDesc& desc);
Centroid centroid(AbstractAccel& accel, const CentroidDesc& desc);

}  // namespace twinray
