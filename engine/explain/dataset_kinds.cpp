#include "explain/dataset_kinds.h"

#include "explain/dataset.h"

namespace cathlab {
namespace {

std::vector<KnownColumn> xyz(const std::string& stem) {
    return {{stem + "x", "mm"}, {stem + "y", "mm"}, {stem + "z", "mm"}};
}

const std::vector<DatasetKind>& table() {
    static const std::vector<DatasetKind> kinds{
        {"catheter-tip",
         {{"insertion", "mm"}, {"rotation", "deg"}, {"proximal_bend", "deg"}, {"distal_bend", "deg"}},
         {xyz("tip_")},
         {}},
        {"tendon-tip", {}, {xyz("tip_")}, {}},  // its inputs are the tendons that [[setup.segment]] names
        {"heart-motion", {}, {{{"displacement", "mm"}}, xyz("")}, {}},
        {"wall-tension", {{"stress", "kPa"}}, {{{"strain", ""}}}, {}},
        {"wall-contact", xyz("tool_"), {xyz("sensor_")}, {{"force", "mN"}}},
    };
    return kinds;
}

}  // namespace

const DatasetKind* find_dataset_kind(const std::string& name) {
    for (const DatasetKind& kind : table())
        if (kind.name == name) return &kind;
    return nullptr;
}

const std::vector<std::string>& dataset_kinds() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> out;
        for (const DatasetKind& kind : table()) out.push_back(kind.name);
        return out;
    }();
    return names;
}

}  // namespace cathlab
