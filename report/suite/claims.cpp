// SPDX-License-Identifier: MIT
#include "report/suite/claims.h"

#include <algorithm>
#include <array>

namespace twinray::suite {
namespace {

constexpr std::size_t aimed = 13;  // the first ones of the cases about any rays
constexpr std::array<std::string_view, 64> any = {
    "W01", "W02", "W03", "W04", "W05", "W06", "W07", "W08", "W09", "W10", "W11", "W16", "W17", "S02", "S03", "S04",
    "S05", "S06", "S07", "S08", "S09", "S10", "S11", "S12", "T01", "T02", "T03", "T06", "T07", "T08", "T09", "T10",
    "T11", "T12", "T13", "N01", "N02", "N03", "N04", "N05", "N06", "N09", "N13", "N15", "I02", "I03", "I05", "I07",
    "I08", "I09", "I11", "I12", "B01", "B02", "B03", "B04", "B05", "B08", "B12", "B15", "B16", "L01", "L02", "L03"};

constexpr std::array<std::string_view, 14> crossed = {"W02", "W03", "W04", "W05", "W06", "W07", "W08",
                                                      "W09", "W11", "W12", "W13", "W16", "W17", "T05"};

}  // namespace

std::span<const std::string_view> cases_about(Subject subject) {
    switch (subject) {
        case Subject::aimed_rays: return std::span(any).first(aimed);
        case Subject::hits: return any;
        case Subject::crossings: return crossed;
    }
    return {};
}

bool is_about(std::string_view case_id, Subject subject) {
    const bool is_of_users_scene = case_id.starts_with('L') && case_id > "L10";
    const bool asks_software_alone = case_id == "F08" || case_id == "F09";  // so that no claim about a driver needs it
    if (is_of_users_scene || asks_software_alone) return subject == Subject::hits;
    const std::span<const std::string_view> ids = cases_about(subject);
    return std::ranges::find(ids, case_id) != ids.end();
}

}  // namespace twinray::suite
