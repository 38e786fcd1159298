// The columns that each kind of data knows, by quantity (the name without its unit).
#pragma once

#include <string>
#include <vector>

namespace cathlab {

struct KnownColumn {
    std::string quantity;
    std::string unit;  ///< after conversion; "" = a pure number
};

struct DatasetKind {
    std::string name;
    std::vector<KnownColumn> inputs;                 ///< all must be there
    std::vector<std::vector<KnownColumn>> measured;  ///< one of these sets must be there, whole
    std::vector<KnownColumn> optional_measured;
};

/// nullptr where there is none of that name.
const DatasetKind* find_dataset_kind(const std::string& name);

}  // namespace cathlab
