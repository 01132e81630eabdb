// SPDX-License-Identifier: MIT
#include "viewer/panels.h"

#include <imgui.h>

#include <algorithm>

#include "viewer/recent_files.h"

namespace twinray::viewer {
namespace {

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
    line("left drag: turn   middle or Shift+left: pan   wheel: nearer");
    line("right drag with W A S D Q E: fly   click: explain   double click: centre");
    ImGui::End();
}

}  // namespace

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

}  // namespace twinray::viewer
