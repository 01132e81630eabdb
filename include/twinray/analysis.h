// SPDX-License-Identifier: MIT
// Quantities computed from scenes by rays: view factors and radiosity, the light of sun and sky, centroids; and the
// horizon of a raster. One file of more than 400 lines, so that a host includes one header for all analyses.
//
// - A face is a triangle of an instance. Faces are numbered by instance, in the order of Scene::instances, then by
//   triangle; those that no ray can hit keep their number and have the area 0.
// - Lengths and areas are the scene's own, in world space, in float64 from float32 vertices and transforms.
// - Intervals are confidence intervals of 95 % and hold whatever the scene.
// - An analysis takes an accelerator and its Faces: made from it, with its instances and vertices as they are now, or
//   from the scene that push_scene() has filled it with. It syncs the accelerator. The same scene and options give the
//   same result on one device.
// - Options out of range, an accelerator or faces of another scene and failures of the device throw Error, which names
//   the object, the value and the limit.
// - Contexts, accelerators and Faces must outlive objects made with them; an object is used by one thread at a time.
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

// The range from the lowest to the highest value, both included.
struct Interval {
    double low = 0, high = 0;

    bool operator==(const Interval&) const = default;
};

// A value estimated from rays, with its confidence interval.
struct Estimate {
    double value = 0;
    Interval interval_95;

    double half_width() const { return (interval_95.high - interval_95.low) / 2; }  // half of the interval's width
};

// Called with the number of rays done since the last call; exchanges_of_pairs() passes numbers of groups.
using ProgressCallback = std::function<void(std::uint64_t)>;

// Faces ---------------------------------------------------------------------------------------------------------------

// A triangle of an instance; both count from 0.
struct Face {
    uint instance, primitive;
};

// The sides of faces that radiate or receive; either side stops rays.
enum class Sides : std::uint8_t {
    front,  // the vertices are counter-clockwise on it, in object space
    both,
};
// Returns the spelling that options use.
constexpr std::string_view name_of(Sides sides) { return sides == Sides::front ? "front" : "both"; }

// How faces are collected into groups.
enum class FaceGrouping : std::uint8_t {
    face,
    mesh,      // for an accelerator: by handle, numbered by its place in AbstractAccel::handles()
    instance,  // by Hit::instance_index
    material,  // by its index in the scene; for an accelerator by Faces::metadata()
    custom,    // Faces::set_custom_groups()
};
std::string_view name_of(FaceGrouping grouping);  // as options spell it

// Returns a vector along the face's front normal, as long as its area in world space; 0 if no ray can hit it.
dvec3 area_vector(const Scene& scene, Face face);
// Returns a checksum of the data that distinguishes faces of scenes: meshes, instances, materials of triangles.
std::uint32_t checksum_of(const Scene& scene);

// The faces of a scene as they are when this is made.
class Faces {
  public:
    // The scene must outlive it, unchanged. Throws Error above 2^32 - 16 faces, and for a coordinate above 2^124 in
    // world space: distances would overflow.
    Faces(Context& context, const Scene& scene);
    Faces(Context& context, const Scene&& scene) = delete;
    // Takes what an accelerator holds after a sync, as scene_of() does. On the device both may share the meshes.
    explicit Faces(AbstractAccel& accel);
    Faces(Faces&&) noexcept;
    Faces& operator=(Faces&&) noexcept;
    ~Faces();
    std::size_t count() const;                                // number of faces, including those without area
    Face operator[](std::size_t face) const;                  // by its number
    const std::vector<double>& areas() const;                 // by face
    const std::vector<std::size_t>& triangle_counts() const;  // by instance
    std::uint64_t bytes() const;                              // device memory, with that of shared meshes
    // These two need Faces of an accelerator and throw Error for others.
    // Returns whether the accelerator has not been synced with edits since.
    bool is_current(AbstractAccel& accel) const;
    // The face_metadata of its meshes, ascending, each once (0 for those without), by number of the group by material.
    const std::vector<uint>& metadata() const;

    // Sets the group of each face, a number below their count. Otherwise throws Error and changes nothing.
    void set_custom_groups(std::vector<uint> groups);
    // Returns the group of each face: its number, or the index of its mesh, instance or material in the scene, or its
    // custom group. Throws Error for custom groups before they are set.
    std::vector<uint> groups(FaceGrouping grouping) const;
    std::size_t group_count(FaceGrouping grouping) const;                 // includes groups without a face
    std::vector<std::vector<uint>> members(FaceGrouping grouping) const;  // those with an area, ascending, by group
    // Returns the sum of the members' areas for each group.
    std::vector<double> areas_of(const std::vector<std::vector<uint>>& groups) const;

    struct State;  // internal
    const State& state() const { return *state_; }

  private:
    std::unique_ptr<State> state_;
};

// View factors --------------------------------------------------------------------------------------------------------
// F_ij is the fraction of the diffuse radiation of group i that meets group j directly (Howell, "A catalog of radiation
// configuration factors"), A_i F_ij = A_j F_ji their exchange.

// The sample points: Owen-scrambled Sobol points (PBRT-v4, 8.7), or random ones.
enum class Sequence : std::uint8_t { sobol, random };
// Returns the spelling that options use.
constexpr std::string_view name_of(Sequence sequence) { return sequence == Sequence::sobol ? "sobol" : "random"; }

// Options for the rows of the matrix.
struct ViewFactorOptions {
    FaceGrouping grouping = FaceGrouping::face;
    // `front`: faces radiate from their fronts, and rays that hit a back side count as neither face nor open. `both`:
    // half of the rays leave each side.
    Sides sides = Sides::front;
    Sequence sequence = Sequence::sobol;
    // Rays per row, 1 to 2^31, rounded up to a multiple of 64; the maximum if target_error is set.
    std::uint64_t rays = 1 << 14;
    // Above 0. A row is done when no interval is longer than twice this; tested at each doubling of rays from 1024 on.
    std::optional<double> target_error = {};
    uint seed = 1;
};

// The method that gave an exchange.
enum class PairEstimator : uint {
    automatic,  // contours if nothing can come between, areas if faces are far apart for their size, else hits
    hits,       // the hits of a row's rays
    area,       // rays between points of both faces (area-to-area sampling)
    contour,    // integrals along both contours (Sparrow 1963), by Gauss-Kronrod quadrature: not an estimate
};
inline constexpr std::array all_pair_estimators = {PairEstimator::automatic, PairEstimator::hits, PairEstimator::area,
                                                   PairEstimator::contour};
// Returns the spelling that options use.
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
    std::uint64_t rays = 0;  // 0 if the group has no area
    // Ascending by target. Entries that are 0 are left out, except for areas whose rays were all blocked, whose
    // interval says more.
    std::vector<ViewFactor> factors;
    std::uint64_t hits = 0;  // rays that met a face
    Estimate open, back;     // fractions that hit nothing, or a back side
};

// A_i F_ij of groups i <= j, with its interval.
struct KnownExchange {
    uint i, j;
    double flow, low, high;
    PairEstimator by;  // `area` if any part of it is by areas
};

// The result of exchanges_of_pairs().
struct PairExchanges {
    std::vector<KnownExchange> known;  // ascending by i, then j
    std::uint64_t left_to_hits = 0;    // pairs of groups that may see each other
    std::uint64_t rays = 0;            // traced between points of faces
};

inline constexpr std::size_t most_paired_faces = 1024;  // that have an area: their pairs are examined one by one

// Computes the exchanges of a scene that contours and areas give, for ViewFactors to use instead of hits. The pairs of
// areas share as many rays as a row has, but two faces get at least 64, and more if their intervals would be wider than
// those of hits; with target_error, their rays are doubled until the interval of both view factors is short enough.
// Throws Error for more than most_paired_faces, and naming the faces if the requested estimator does not fit a pair.
PairExchanges exchanges_of_pairs(AbstractAccel& accel, const Faces& faces, const ViewFactorOptions& options,
                                 PairEstimator estimator, const ProgressCallback& progress = {});

// The matrix of view factors, row by row, from rays that leave each face uniformly by area and by cosine.
class ViewFactors {
  public:
    // `known` replaces the results of rays; rows that contours fill get 1024 rays at most.
    ViewFactors(AbstractAccel& accel, const Faces& faces, const ViewFactorOptions& options,
                std::span<const KnownExchange> known = {});
    // Faces must outlive it.
    ViewFactors(AbstractAccel&, const Faces&&, const ViewFactorOptions&, std::span<const KnownExchange> = {}) = delete;
    ~ViewFactors();

    std::size_t row_count() const;             // the number of groups
    const std::vector<double>& areas() const;  // by group
    std::size_t batch_size() const;            // the number of rows that are best computed at a time
    // Returns rows [first, last), in order. A row depends only on the options and the scene.
    std::vector<ViewFactorRow> rows(std::size_t first, std::size_t last);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Deviations of a whole matrix from the laws of view factors. `rows`: all, in order; areas: by group.
struct ViewFactorResiduals {
    double reciprocity = 0;         // largest |A_i F_ij - A_j F_ji| over the largest area
    double reciprocity_scaled = 0;  // the same, over the smaller area of the two
    double reciprocity_sigma =
        0;               // the same in its standard errors, of pairs with at least 10 rays expected either way
    double closure = 0;  // largest |1 - sum_j F_ij - open - back| of rows with an area
};
// Computes them for a whole matrix.
ViewFactorResiduals residuals_of(const std::vector<ViewFactorRow>& rows, const std::vector<double>& areas);

// Makes the least change, in squares weighted by inverse binomial variances, after which A_i F_ij = A_j F_ji but for
// rounding to float32, and rows with `open` and `back`, which change too, add up to 1 (Lawson, "Improving the accuracy
// of view factors by least squares smoothing"). Entries seen in only one direction are completed; intervals move with
// their values and keep their widths, which is more than they need. Throws Error if the solver does not converge.
void project(std::vector<ViewFactorRow>& rows, const std::vector<double>& areas);

// Finished rows on disk, so that an interrupted run can continue: appended in order and flushed, each with a checksum.
class RowFile {
  public:
    // `configuration` describes the rows, which begin with `first_row`: the same in all runs that share the file.
    RowFile(std::filesystem::path file, const std::string& configuration, std::size_t first_row = 0);
    ~RowFile();
    // Returns the rows in the file up to the first gap, none if there is no file; append() cuts off what follows them.
    // Throws Error if the file is of another configuration.
    std::vector<ViewFactorRow> load();
    void create();  // starts an empty file
    // Needs load() or create() before. Throws Error naming the file if it cannot be written.
    void append(std::span<const ViewFactorRow> rows);
    void remove();  // the file, if it is there

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Diffuse light or heat between groups: B = E + rho F B, where B leaves a group per area, E is emitted and rho is the
// reflected fraction of the arriving light or heat.
struct Radiosity {
    std::vector<double> values;    // B, in the unit of emission
    std::vector<double> incident;  // F B: arrives per area
    double relative_residual = 0;  // |E + rho F B - B| over |B|, largest entries
    double amplification = 0;      // largest row sum of (I - rho F)^-1: 1 / (1 - rho) in a closed room of one rho
    double forward_error = 0;      // bound of the largest |B - B_exact| over the largest |B|, for this F
    // Half the interval of B due to that of F, to first order, as if all rows erred the same way: an upper bound.
    std::vector<double> sampling;
    int iterations = 0;  // iterations of the solver for B
};
// `rows` are those of a whole matrix, in order; emission, finite, and reflectance, in [0, 1], have one entry per row.
// Rows without rays keep B = E. Solved by BiCGSTAB in float64 and refined until the residual is below `tolerance`.
// Throws Error if it does not converge, as for a closed room that reflects everything, and for wrong sizes or values.
Radiosity solve_radiosity(const std::vector<ViewFactorRow>& rows, std::span<const double> emission,
                          std::span<const double> reflectance, double tolerance = 1e-13);

// Light ---------------------------------------------------------------------------------------------------------------

// The points of their cells through which rays of a grid pass.
enum class GridPoints : std::uint8_t {
    random,   // one in each cell, uniform and independent: means are unbiased and have intervals
    centers,  // cell centres: the same rays for every seed
};

// Parallel rays through the cells of a grid in front of the scene, which covers everything of it that is visible.
struct RayGridDesc {
    dvec3 direction = dvec3(0, 0, -1);  // the rays' direction in world space; finite, of any length but 0
    uint side = 1000;                   // side * side rays; 1 to 65535
    GridPoints points = GridPoints::random;
    std::uint64_t seed = 1;
};

// Options of illuminate().
struct IlluminationDesc {
    RayGridDesc grid;
    Sides sides = Sides::both;
    FaceGrouping by = FaceGrouping::face;
    ProgressCallback progress = {};
};

// Areas are projected: as seen along the light, in proportion to what a plane across it would receive. Divided by the
// cosine, they are areas of the face itself.
struct LitArea {
    std::uint64_t hits = 0;   // rays whose closest hit it is; times cell_area an unbiased area with random points
    double area = 0;          // that, but no more than `unobstructed`
    Interval interval;        // of `area`; with cell centres, the whole possible range
    double unobstructed = 0;  // the area if nothing else were there
    double surface = 0;       // the area of the faces themselves, in world space

    // Returns the lit fraction of the area that is turned to the light; 0 if there is none.
    double fraction() const { return unobstructed > 0 ? area / unobstructed : 0; }
    // Returns the mean over the faces, in units of the light that a plane across it receives.
    double irradiance() const { return surface > 0 ? area / surface : 0; }
};

// The result of illuminate(): one entry per group.
struct Illumination {
    std::vector<LitArea> groups;
    LitArea total;  // hits of all groups, as one group
    std::uint64_t ray_count = 0;
    double cell_area = 0;
};
// Computes the parts of a scene that parallel light reaches. Intervals: hits of random points are independent, and how
// often neighbours differ bounds their variance. Throws Error also if float32 rays cannot start outside the scene.
Illumination illuminate(AbstractAccel& accel, const Faces& faces, const IlluminationDesc& desc);

// Options of sky_light() and sun_hours().
struct SkyRaysDesc {
    uint samples = 256;  // rays per face; 1 to 2^20
    Sides sides = Sides::both;
    std::uint64_t seed = 1;
    ProgressCallback progress = {};
    std::size_t first_face = 0, last_face = SIZE_MAX;  // faces before and from there on get 0
};

// The light that a face received.
struct Received {
    std::uint64_t free_rays = 0;  // rays that left the scene
    double value = 0;
    Interval interval;
};

// The result of sky_light() and sun_hours(): one entry per face.
struct SkyLight {
    std::vector<Received> faces;
    std::uint64_t ray_count = 0;
};

// Returns the light that each face receives, mean over its points, from a sky of uniform radiance above the horizon, in
// units of what an unobstructed horizontal plane receives. For its front this is the sky view factor, (1 + cos) / 2 for
// an unobstructed face tilted by an angle, and never more; for both sides together 1 for any such face. `zenith`:
// finite, of any length but 0.
SkyLight sky_light(AbstractAccel& accel, const Faces& faces, dvec3 zenith, const SkyRaysDesc& desc);

// A position of the sun and how long it stays there.
struct SunPosition {
    dvec3 direction;   // direction of its rays; finite, of any length but 0
    double hours = 1;  // how long it stays; finite and not negative
};
// Returns the hours for which a point of a face is lit, mean over the face: for each position `desc.samples` rays per
// face, from stratified points. A side lit at a grazing angle counts like any other.
SkyLight sun_hours(AbstractAccel& accel, const Faces& faces, std::span<const SunPosition> positions,
                   const SkyRaysDesc& desc);

// Divisions of the sky into patches, numbered as in Radiance: by row from the horizon up, in a row from north by east,
// the zenith's last; z is up, y north. Tregenza, "Subdivision of the sky hemisphere for luminance measurements" (1987),
// and Reinhart's division of each patch into 2 x 2 or 4 x 4.
inline constexpr std::array<std::string_view, 3> sky_names = {"tregenza145", "reinhart577", "reinhart2305"};
// A part of the sky, given by its middle.
struct SkyPatch {
    dvec3 direction;         // a unit vector
    double solid_angle = 0;  // steradians; 2 pi for all patches together
};
// Returns the patches of one of sky_names; throws Error for another name.
std::vector<SkyPatch> sky_patches(std::string_view name);

// A raster of heights, of at most 2^20 columns and rows. With c for a column and r for a row, its surface is the
// triangles (c, r), (c + 1, r), (c + 1, r + 1) and (c, r), (c + 1, r + 1), (c, r + 1) between the middles of cells.
struct HeightRaster {
    std::span<const float> heights;  // row by row; NaN where the raster has no height
    uint columns = 0, rows = 0;      // at least 2 each; fewer than 2^30 cells
};
// The answers of horizon() for a cell: slope, the horizon's height over its distance, one a way, at least 0; or one
// number, the part of a uniform sky's light on a horizontal plane, or of the hemisphere, that is above the horizon.
enum class HorizonMeasure { slope, light, solid_angle };
// Options of horizon(). Lengths are in the unit of the heights.
struct HorizonDesc {
    uvec2 corner = {}, size = {};  // columns and rows of the cells asked for
    // Columns and rows per length: {sin(a) / 30, -cos(a) / 30} for azimuth a over cells of 30 whose rows go south.
    std::span<const vec2> ways = {};
    HorizonMeasure measure = HorizonMeasure::slope;
    float lift = 0;          // of the eye above its cell, at least 0
    float curvature = 0;     // of the planet: one over its radius
    float reach = INFINITY;  // how far the raster hides anything
};
// Finds the horizon along lines, without rays and accelerators, at the points where they cross edges of triangles: on a
// plane its highest. Answers are row by row of the cells asked for, a cell's by way; those of a cell without a height
// are NaN. They do not depend on the raster beyond `reach`. Throws Error for what a member's comment does not allow,
// and for 2^31 answers or more.
std::vector<float> horizon(Context& context, const HeightRaster& raster, const HorizonDesc& desc);

// Options of visibility().
struct VisibilityDesc {
    // The range of hits that count, in lengths of a direction: nearer hits are ignored for points on the scene itself.
    float t_near = 0, t_far = INFINITY;
    ProgressCallback progress = {};
};
// Returns 1 for each point and direction, of any length, if nothing is on the ray, else 0; rows are points. With
// normals, a direction that does not leave the side of the point's normal gives 0, and rays begin off the point by the
// largest rounding error of a surface there. Throws Error for another count of normals, and more than 2^20 directions.
std::vector<std::uint8_t> visibility(AbstractAccel& accel, std::span<const vec3> points,
                                     std::span<const vec3> directions, std::span<const vec3> normals = {},
                                     const VisibilityDesc& desc = {});

// Options of centroid().
struct CentroidDesc {
    RayGridDesc grid;
    bool keeps_points = false;
    ProgressCallback progress = {};
};

// The result of centroid().
struct Centroid {
    std::uint64_t ray_count = 0;
    std::uint64_t point_count = 0;  // rays that hit
    std::optional<dvec3> mean;      // of the closest points of all rays; none if nothing is hit
    // Its standard error by axis, on average not too low; only with random points: centres are not independent.
    std::optional<dvec3> standard_error;
    std::vector<dvec3> points;  // in the order of the rays; empty unless CentroidDesc::keeps_points
};
// Returns the mean of the points that are visible along a direction. Throws Error as illuminate() does.
Centroid centroid(AbstractAccel& accel, const Scene& scene, const CentroidDesc& desc);
Centroid centroid(AbstractAccel& accel, const CentroidDesc& desc);

}  // namespace twinray
