// The window of a Viewer, with its events and what is drawn over pictures: settings, figures, the sheet of keys, what
// was picked.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

#include "viewer/viewer.h"

#include <deque>
#include <fstream>
#include <iostream>
#include <utility>

#include "engine/core/error.h"
#include "viewer/files.h"
#include "viewer/screen.h"

namespace twinray::viewer {
namespace {

constexpr double double_click_seconds = 0.35;
constexpr double idle_seconds = 0.25;  // between looks at a picture that gets no better

std::string name_of_key(int key) {
    switch (key) {
        case GLFW_KEY_HOME: return "Home";
        case GLFW_KEY_TAB: return "Tab";
        case GLFW_KEY_SPACE: return "Space";
        case GLFW_KEY_ESCAPE: return "Escape";
        case GLFW_KEY_LEFT_BRACKET: return "[";
        case GLFW_KEY_RIGHT_BRACKET: return "]";
        case GLFW_KEY_MINUS: return "-";
        case GLFW_KEY_EQUAL: return "=";
        default: break;
    }
    if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12) return "F" + std::to_string(key - GLFW_KEY_F1 + 1);
    if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9)
        return std::string(1, static_cast<char>('0' + key - GLFW_KEY_KP_0));
    if ((key >= GLFW_KEY_A && key <= GLFW_KEY_Z) || (key >= GLFW_KEY_0 && key <= GLFW_KEY_9))
        return std::string(1, static_cast<char>(key));
    return {};
}

Button button_of(int button) {
    return button == GLFW_MOUSE_BUTTON_LEFT    ? Button::left
           : button == GLFW_MOUSE_BUTTON_RIGHT ? Button::right
                                               : Button::middle;
}

// GLFW as an object: what it calls back becomes events.
class Glfw {
  public:
    Glfw(unsigned width, unsigned height) {
        if (!glfwInit()) fail("window: there is no display (--screenshot and --headless do not need one): ", reason());
        glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
        window_ = glfwCreateWindow(static_cast<int>(width), static_cast<int>(height), "twinray", nullptr, nullptr);
        if (!window_) {
            const std::string why = reason();
            glfwTerminate();
            fail("window: it cannot be opened: ", why);
        }
        glfwSetWindowUserPointer(window_, this);
        glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) { of(w).on_key(key, action); });
        glfwSetMouseButtonCallback(
            window_, [](GLFWwindow* w, int button, int action, int mods) { of(w).on_button(button, action, mods); });
        glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) { of(w).on_move(x, y); });
        glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) {
            if (!ImGui::GetIO().WantCaptureMouse) of(w).events.push_back(Scrolled{y});
        });
        glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int x, int y) {
            of(w).events.push_back(Resized{static_cast<unsigned>(x), static_cast<unsigned>(y)});
        });
        glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** files) {
            if (count > 0) of(w).events.push_back(Dropped{files[0]});
        });
    }
    ~Glfw() {
        glfwDestroyWindow(window_);
        glfwTerminate();
    }
    Glfw(const Glfw&) = delete;
    Glfw& operator=(const Glfw&) = delete;

    GLFWwindow* window() const { return window_; }
    // Tells the size in pixels, which may differ from the requested one.
    void tell_size() {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window_, &width, &height);
        events.push_back(Resized{static_cast<unsigned>(width), static_cast<unsigned>(height)});
    }
    std::deque<Event> events;

  private:
    static Glfw& of(GLFWwindow* window) { return *static_cast<Glfw*>(glfwGetWindowUserPointer(window)); }
    static std::string reason() {
        const char* why = nullptr;
        glfwGetError(&why);
        return why ? why : "unknown";
    }
    void on_key(int key, int action) {
        if (action == GLFW_REPEAT || ImGui::GetIO().WantTextInput) return;
        const std::string name = name_of_key(key);
        if (name.empty()) return;
        if (action == GLFW_PRESS)
            events.push_back(KeyDown{name});
        else
            events.push_back(KeyUp{name});
    }
    void on_button(int button, int action, int mods) {
        if (action == GLFW_PRESS && ImGui::GetIO().WantCaptureMouse) return;
        if (action == GLFW_RELEASE) return events.push_back(ButtonUp{button_of(button)});
        const double now = glfwGetTime();
        if (button == GLFW_MOUSE_BUTTON_LEFT && now - clicked_ < double_click_seconds)
            events.push_back(DoubleClick{x_, y_});
        clicked_ = button == GLFW_MOUSE_BUTTON_LEFT ? now : -1;
        events.push_back(ButtonDown{button_of(button), x_, y_, (mods & GLFW_MOD_SHIFT) != 0});
    }
    // The position is in pixels, which are more than the system's units on some screens.
    void on_move(double x, double y) {
        int units_x = 1, units_y = 1, pixels_x = 1, pixels_y = 1;
        glfwGetWindowSize(window_, &units_x, &units_y);
        glfwGetFramebufferSize(window_, &pixels_x, &pixels_y);
        x_ = units_x > 0 ? x * pixels_x / units_x : x;
        y_ = units_y > 0 ? y * pixels_y / units_y : y;
        events.push_back(Moved{x_, y_});
    }

    GLFWwindow* window_ = nullptr;
    double x_ = 0, y_ = 0, clicked_ = -1;
};

// Texts are shown as they are: none of them is a format.
void line(const std::string& text) { ImGui::TextUnformatted(text.c_str()); }

template <class T, std::size_t n>
void combo(const char* label, T& value, const std::array<T, n>& all) {
    if (!ImGui::BeginCombo(label, std::string(name_of(value)).c_str())) return;
    for (const T each : all)
        if (ImGui::Selectable(std::string(name_of(each)).c_str(), each == value)) value = each;
    ImGui::EndCombo();
}

void settings(Viewer& viewer) {
    State state = viewer.state();
    combo("colours", state.layer, all_layers);
    if (viewer.stage().hardware()) combo("hits", state.shown, all_shown);
    combo("level", state.level, all_levels);
    if (!viewer.stage().has_level(state.level)) state.level = Level::watertight;
    if (state.shown == Shown::wipe) ImGui::SliderFloat("wipe", &state.wipe, 0, 1);
    int depth = state.tree_depth.value_or(-1);
    if (ImGui::SliderInt("tree level", &depth, -1, 32))
        state.tree_depth = depth < 0 ? std::nullopt : std::optional(depth);
    if (state.layer == Layer::path) ImGui::Checkbox("kernels for every scene", &state.has_all_features);
    if (state.layer == Layer::path) ImGui::SliderFloat("exposure", &state.exposure, -8, 8, "%.1f stops");
    if (state.layer == Layer::light) {
        auto hour = static_cast<float>(state.hour);
        if (ImGui::SliderFloat("time of day", &hour, 6, 18, "%.1f h")) state.hour = static_cast<double>(hour);
    }
    if (const double seconds = viewer.stage().animation_seconds(); seconds > 0) {
        auto time = static_cast<float>(state.seconds);
        if (ImGui::SliderFloat("animation", &time, 0, static_cast<float>(seconds), "%.2f s"))
            state.seconds = static_cast<double>(time);
    }
    if (state != viewer.state()) viewer.set_state(state);
}

void recent(Viewer& viewer) {
    if (!ImGui::BeginCombo("file", viewer.stage().file().filename().string().c_str())) return;
    for (const std::filesystem::path& file : recent_files(recent_list()))
        if (ImGui::Selectable(file.string().c_str(), false)) viewer.handle(Dropped{file});
    ImGui::EndCombo();
}

void sheet(const Viewer& viewer) {
    ImGui::SetNextWindowPos(ImVec2(ImGui::GetIO().DisplaySize.x - 10, 10), ImGuiCond_FirstUseEver, ImVec2(1, 0));
    if (!ImGui::Begin("Keys", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return ImGui::End();
    if (ImGui::BeginTable("keys", 3)) {
        for (const Key& key : all_keys()) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            line(std::string(key.name));
            ImGui::TableNextColumn();
            line(std::string(key.what));
            ImGui::TableNextColumn();
            line(state_of(key, viewer.state()));
        }
        ImGui::EndTable();
    }
    line("left drag: orbit   middle or Shift+left: pan   wheel: zoom");
    line("right drag with W A S D Q E: fly   click: explain   double-click: set centre");
    ImGui::End();
}

// Draws between the begin and the end of a frame of Dear ImGui.
void draw_panels(Viewer& viewer) {
    if (viewer.shows_panel()) {
        ImGui::SetNextWindowPos(ImVec2(10, 10), ImGuiCond_FirstUseEver);
        if (ImGui::Begin("twinray", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
            recent(viewer);
            settings(viewer);
            ImGui::Separator();
            for (const std::string& figure : viewer.figures()) line(figure);
            if (!viewer.message().empty()) line(viewer.message());
            line("H: keys");
        }
        ImGui::End();
    }
    if (viewer.shows_sheet()) sheet(viewer);
    if (viewer.picked()) {
        ImGui::SetNextWindowPos(ImVec2(10, ImGui::GetIO().DisplaySize.y - 10), ImGuiCond_FirstUseEver, ImVec2(0, 1));
        if (ImGui::Begin("picked ray", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
            line(text_of(*viewer.picked()));
            if (ImGui::CollapsingHeader("step by step")) line(viewer.explanation());
        }
        ImGui::End();
    }
}

struct Overlay {
    Overlay(GLFWwindow* window, Screen& screen) : screen_(screen) {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui_ImplGlfw_InitForVulkan(window, true);
        screen.start_overlay();
    }
    ~Overlay() {
        screen_.end_overlay();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    Overlay(const Overlay&) = delete;
    Overlay& operator=(const Overlay&) = delete;

    static void draw(Viewer& viewer) {
        ImGui_ImplVulkan_NewFrame();
        ImGui_ImplGlfw_NewFrame();
        ImGui::NewFrame();
        draw_panels(viewer);
        ImGui::Render();
    }

  private:
    Screen& screen_;
};

// Events from a file, between frames.
class Player {
  public:
    explicit Player(std::deque<Event> events) : events_(std::move(events)) {}
    bool is_playing() const { return !events_.empty() || frames_ > 0; }
    void play(Viewer& viewer) {
        if (frames_ > 0) --frames_;
        while (frames_ == 0 && !events_.empty()) {
            const Event event = std::move(events_.front());
            events_.pop_front();
            if (const auto* frames = std::get_if<Frames>(&event)) {
                frames_ = frames->count;
            } else if (const auto* shot = std::get_if<Shot>(&event)) {
                const Raster& picture = viewer.frame(false);
                write_png(shot->file, picture.width, picture.height, picture.pixels);
            } else {
                viewer.handle(event);
            }
        }
    }

  private:
    std::deque<Event> events_;
    unsigned frames_ = 0;  // to pass before the next
};

// Events into a file, with the frames between them.
class Recorder {
  public:
    explicit Recorder(const std::filesystem::path& file) {
        if (!file.empty()) out_.open(file);
    }
    void write(const Event& event) {
        if (!out_.is_open()) return;
        if (frames_ > 0) out_ << text_of(Frames{std::exchange(frames_, 0)}) << '\n';
        out_ << text_of(event) << std::endl;
    }
    void pass_frame() { ++frames_; }

  private:
    std::ofstream out_;
    unsigned frames_ = 0;
};

}  // namespace

int run_window(const WindowDesc& desc) {
    std::deque<Event> played;
    if (!desc.play.empty())
        for (Event& event : read_events(desc.play)) played.push_back(std::move(event));
    Glfw glfw(desc.viewer.state.width, desc.viewer.state.height);
    Screen screen(glfw.window(), desc.context);
    Context context(screen.device().adopted());
    ViewerDesc viewer_desc = desc.viewer;
    viewer_desc.say = [&](const std::string& line) {
        desc.viewer.say(line);
        glfwSetClipboardString(glfw.window(), line.c_str());
    };
    Viewer viewer(context, viewer_desc);
    keep_recent(recent_list(), viewer.stage().file());
    const Overlay overlay(glfw.window(), screen);
    Player player(played);
    Recorder recorder(desc.record);
    glfw.tell_size();
    double looked = 0;        // for changes of the file
    bool has_failed = false;  // the frame before
    while (!viewer.is_closed() && !glfwWindowShouldClose(glfw.window())) {
        if (viewer.is_refining() || player.is_playing())
            glfwPollEvents();
        else
            glfwWaitEventsTimeout(idle_seconds);
        try {
            for (; !glfw.events.empty(); glfw.events.pop_front()) {
                recorder.write(glfw.events.front());
                viewer.handle(glfw.events.front());
                if (std::holds_alternative<Dropped>(glfw.events.front()))
                    keep_recent(recent_list(), viewer.stage().file());
            }
            player.play(viewer);
            if (glfwGetTime() - looked > idle_seconds) {
                viewer.reload_if_changed();
                looked = glfwGetTime();
            }
            viewer.frame(true);
            has_failed = false;
        } catch (const DeviceLost&) {
            throw;
        } catch (const Error& error) {
            if (has_failed) throw;
            has_failed = true;
            glfw.events.clear();
            viewer.recover(error.what());
            continue;
        }
        recorder.pass_frame();
        Overlay::draw(viewer);
        if (!screen.present(viewer.last())) glfwWaitEventsTimeout(idle_seconds);  // minimised
    }
    screen.wait();
    if (screen.device().validation_messages() > 0)
        std::cerr << screen.device().validation_messages() << " validation messages\n";
    return screen.device().validation_messages() == 0 ? 0 : 1;
}

}  // namespace twinray::viewer
