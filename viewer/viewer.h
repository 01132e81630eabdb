// The viewer without its window: events in, frames out. It shows its State; the window only brings events and shows
// frames, so that every state can be made, and tested, without a display. The window of a Viewer comes last.
#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <twinray/analysis.h>
#include <twinray/queries.h>
#include <twinray/tlas.h>
#include <twinray/validation.h>

#include "renderer/lights.h"
#include "renderer/renderer.h"
#include "renderer/scene_upload.h"
#include "viewer/events.h"
#include "viewer/layers.h"

namespace twinray::viewer {

// A scene on both accelerators, and what is made of it only when it is asked for.
class Stage {
  public:
    // Throws Error as load_scene() does.
    Stage(Context& context, const std::filesystem::path& file);

    const std::filesystem::path& file() const { return file_; }
    const Scene& scene() const { return scene_; }
    const Bounds& bounds() const { return bounds_; }
    SwTlas& software() { return software_; }
    HwTlas* hardware() { return hardware_.get(); }                           // null: see why_no_hardware()
    const std::string& why_no_hardware() const { return why_no_hardware_; }  // "" where there is one
    Context& context() const { return context_; }
    double build_seconds() const { return build_seconds_; }  // of both, with uploads

    double refit_seconds() const { return refit_seconds_; }  // of the last pose, on both; 0: there was none
    // Tells whether an animation moves it, and how long the first one lasts.
    double animation_seconds() const;
    // Poses the scene; both accelerators follow.
    void set_time(double seconds);
    // Counts what set_time() has changed.
    std::uint64_t version() const { return version_; }

    const Reference& reference();
    const reference::Scene& cpu_reference();  // the software accelerator on the host
    const Faces& faces();
    PointQuery& points();  // of the software accelerator, as it is
    bool has_level(Level level) const;

  private:
    void push();

    Context& context_;
    std::filesystem::path file_;
    Scene scene_;
    Bounds bounds_;
    SwTlas software_;
    std::unique_ptr<HwTlas> hardware_;
    std::string why_no_hardware_;
    std::vector<AccelHandle> software_handles_, hardware_handles_;  // by mesh with instances
    double build_seconds_ = 0, refit_seconds_ = 0;
    std::optional<double> time_;  // of the pose; none: not posed yet
    std::uint64_t version_ = 0;
    std::unique_ptr<Reference> reference_;
    std::unique_ptr<reference::Scene> cpu_reference_;
    std::unique_ptr<Faces> faces_;
    std::unique_ptr<PointQuery> points_;
};

// Path traces the scene, one sample of each pixel after the other.
class PathPicture {
  public:
    // Compiles and uploads what the scene needs in its present state: `version` distinguishes it from later ones. The
    // scene must outlive this. has_all_features: compiles what any scene may need, to see what leaving out saves.
    PathPicture(Context& context, const Scene& scene, std::uint64_t version, bool has_all_features);
    bool is_of(std::uint64_t version, bool has_all_features) const {
        return version_ == version && has_all_features_ == has_all_features;
    }

    // Starts again if the view differs from the last one.
    void look(const Orbit& orbit, uint width, uint height);
    void add_sample(AbstractAccel& accel);
    uint samples() const { return samples_; }
    double seconds() const;  // the time that the samples took
    std::uint64_t rays() const;
    // Bounds the relative error (see Film::error()) at the last power of two of samples; infinite before two.
    double error() const { return error_; }
    Raster picture(float exposure) const;

  private:
    struct View {
        Orbit orbit;
        uint width = 0, height = 0;
        bool operator==(const View&) const = default;
    };

    Context& context_;
    std::uint64_t version_;
    bool has_all_features_;
    path_tracer::LocalLights lights_;
    std::unique_ptr<path_tracer::EnvironmentMap> environment_;
    std::unique_ptr<path_tracer::DeviceScene> device_scene_;
    std::unique_ptr<path_tracer::Renderer> renderer_;
    View view_;
    path_tracer::Film film_;
    uint samples_ = 0;
    double error_ = INFINITY;
};

struct ViewerDesc {
    std::filesystem::path file;
    State state;
    // The camera's position and the point that it looks at, in the file's coordinates; none: the scene's first camera,
    // or a view of all. The rest is in state.orbit.
    std::optional<std::array<dvec3, 2>> camera;
    std::function<void(const std::string&)> say;  // tells what keys report, such as the camera's options
    std::string version;                          // of twinray
};

// All that is said of one ray: by both accelerators, by the float64 reference, and on the way through the tree.
struct Pick {
    Ray ray{};
    Hit software{}, hardware{};
    bool has_hardware = false;
    ReferenceHit reference;
    HitClass software_class = HitClass::agree, hardware_class = HitClass::agree;
    std::optional<dvec3> point;                          // of the software's hit, in world space
    std::optional<std::size_t> face;                     // of the same, by instance, then by triangle
    std::uint64_t nodes = 0, boxes = 0, primitives = 0;  // the software tree's, which the ray asks for
};
// Returns a line each for the ray, the hits and what they are worth, and steps.
std::string text_of(const Pick& pick);
// Returns triangle tests and boxes on the way to what either says, in float32 and exactly.
std::string explanation_of(Stage& stage, const Pick& pick);

class Viewer {
  public:
    // Throws Error as load_scene() does.
    Viewer(Context& context, const ViewerDesc& desc);

    void handle(const Event& event);
    // Returns the next frame: coarse while the camera moves, then whole, then better and better.
    const Raster& frame(bool may_be_coarse);
    const Raster& last() const { return raster_; }
    // Returns whether another frame would be better than the last.
    bool is_refining() const;
    // Returns whether frames at rest are samples of Layer::path.
    bool traces_paths() const { return state_.layer == Layer::path && state_.shown != Shown::difference; }
    bool is_closed() const { return is_closed_; }

    const State& state() const { return state_; }
    void set_state(const State& state);
    // Goes on with the plainest layer after an error, of which the user is told.
    void recover(const std::string& why);
    // Reads the file again if it has changed since; goes on with the present scene if it cannot be read.
    void reload_if_changed();
    Stage& stage() { return *stage_; }
    const std::optional<Pick>& picked() const { return pick_; }
    const std::string& explanation();  // of the picked ray; made when it is asked for
    // Returns lines about device, trees, times and what is shown.
    std::vector<std::string> figures() const;
    // Returns the meaning of colours of values; empty: they have none.
    const Values& values() const { return values_; }
    // Returns a sentence for the user about what just happened; empty: nothing did.
    const std::string& message() const { return message_; }
    bool shows_panel() const { return shows_panel_; }
    bool shows_sheet() const { return shows_sheet_; }
    uint samples() const;  // a pixel, of Layer::path
    double path_rays_a_second() const;
    double path_error() const;                                      // as PathPicture::error()
    std::uint64_t disagreements() const { return disagreements_; }  // pixels, of Shown::difference

  private:
    void open(const std::filesystem::path& file);
    bool try_open(const std::filesystem::path& file);  // false: the message says why not
    void look_at_all();
    void set_reach();
    void reload();
    void forget_pick();
    void press(const Key& key);
    void drag(double x, double y);
    void fly();
    void pick_at(double x, double y);
    void center_at(double x, double y);
    std::string command_line() const;

    AbstractAccel& accel_of(Shown shown);
    FacePicture drawn(uint grain, bool is_moving);
    Raster shaded(Shown shown, const Traced& traced, bool is_moving);
    Raster difference(const Traced& software, const Traced& hardware, uint grain);
    std::vector<Hit> hits_of(AbstractAccel& accel, std::span<const Ray> rays);
    Values distances_of(const Traced& traced);
    void update_values();
    Values steps_of(const Traced& traced);
    void draw_over(FacePicture& picture);
    void draw_legend(Raster& raster) const;
    const PathPicture* shown_path() const;  // null: none yet

    Context& context_;
    std::function<void(const std::string&)> say_;
    std::string version_;
    State state_;
    std::unique_ptr<Stage> stage_;
    std::filesystem::file_time_type written_{};          // the file, when it was read
    std::array<std::unique_ptr<PathPicture>, 2> paths_;  // by Shown::software, hardware
    std::optional<Pick> pick_;
    std::string explanation_;
    struct ValuesKey {
        Layer layer;
        std::uint64_t version;
        std::optional<std::size_t> face;
        double hour;
        bool operator==(const ValuesKey&) const = default;
    };
    Values values_;
    std::optional<ValuesKey> values_of_;  // the state that values_ were computed for
    std::uint64_t disagreements_ = 0;
    std::size_t tree_boxes_ = 0;
    double tree_area_ = 0;          // of all of them, in areas of the root
    std::size_t camera_ = 0;        // of the file, that was looked through last
    double rays_a_second_ = 0;      // of the last frame's hits
    std::vector<Stroke> segments_;  // where triangles cross, for Layer::collisions
    Raster raster_{1, 1};
    State shown_;            // what raster_ shows
    bool is_coarse_ = true;  // raster_ is
    bool is_stale_ = true;
    uint grain_ = 1;  // pixels of a coarse frame, along each side
    double frame_seconds_ = 0;
    std::string message_;
    bool shows_panel_ = true, shows_sheet_ = false, is_closed_ = false, is_playing_ = false;
    std::optional<Button> button_;
    bool has_shift_ = false, has_dragged_ = false, is_double_ = false;
    double x_ = 0, y_ = 0;
    std::vector<std::string> held_;  // keys, while the right button is down
};

struct WindowDesc {
    ContextDesc context;  // name, device and log of it
    ViewerDesc viewer;
    std::filesystem::path play, record;  // events; empty: none
};
// Runs until the window is closed; returns the exit status. Throws Error if there is no display, or if twinray was
// built without GLFW or Dear ImGui.
int run_window(const WindowDesc& desc);

}  // namespace twinray::viewer
