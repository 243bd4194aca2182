#pragma once

#include "find/find.h"
#include "find/verification.h"
#include "find/view.h"

#include <vector>

namespace fettle::find {

/// A part seen from one side, and the finds there.
struct SeenSide {
    View view;
    HeightMap surface;            ///< heights of what is seen
    HeightMap searched;           ///< `surface`, or signed distances from a reference along its normals
    bool is_along_normal = false; ///< `searched` has distances from a reference
    std::vector<Verified> finds;  ///< in `searched`
};

/// Points of a part by the cell that they fall into, as linked lists.
struct CellPoints {
    cv::Mat1i first;                ///< point of a cell, -1: none
    std::vector<Eigen::Index> next; ///< point of the same cell after each, -1: none

    std::vector<Eigen::Index> in(const cv::Point& cell) const; ///< a cell beside the map has none
};
CellPoints points_by_cell(const mesh::CloudMesh& part, const SeenSide& side);

/// Measures a find, without its outlines and number.
FoundAnomaly describe(const mesh::CloudMesh& part, const SeenSide& side, const CellPoints& cells, const Verified& find);

/// Sets boundary and sampling boundary. @param others  cells of the other anomalies, of the map's size
void set_outlines(FoundAnomaly& anomaly, const SeenSide& side, const Verified& find, const Mask& others);

} // namespace fettle::find
