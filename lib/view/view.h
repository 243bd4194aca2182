#pragma once

#include "draw/html.h"
#include "draw/picture.h"
#include "mesh/cloud_mesh.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace fettle::view {

/// A part in a view, M, mm; a click shows one layer or another, from the same direction and at the same scale.
struct Layer {
    std::string name; ///< of its button
    mesh::CloudMesh part;
    std::vector<std::string>
        fields;              ///< z, fields of its points, `class`, `rgb`; at least one, the first is shown at first
    std::string source = {}; ///< name of its file, for messages; empty: `name`
};

struct ViewOptions {
    draw::PictureOptions picture; ///< job, units, scale, bands and palette; its other members are not used
    std::optional<double>
        error_limit;          ///< of the errors' colours, instead of picture.scale, which other fields have too
    Eigen::Matrix3Xd touches; ///< 3xN, M, mm, drawn as dots
    bool pick = false;        ///< clicks set the corners of B and S
};

/// A view that can be turned, in a page that has view_style() in its head and view_script() at its end: the element
/// carries its data. Colours are those of draw::picture(), of the same range; layers share the range of a field.
/// @param fallback  shown where there is no WebGL 2
/// @throws InputError if a layer has no such field, or no finite point
draw::Html view_element(const std::vector<Layer>& layers, const ViewOptions& options, const draw::Html& fallback);

draw::Html view_style();
draw::Html view_script();

/// A self-contained page of one view, as large as the window. @param title  headline; may be empty
std::string view_page(const std::vector<Layer>& layers, const ViewOptions& options, const std::string& title);

/// The fields that are shown of a part unless others are asked for: its error, else z; and its classes.
std::vector<std::string> default_fields(const cloud::Cloud& points);

/// A part as the pictures take it.
mesh::MeshOrCloud as_shape(const mesh::CloudMesh& part);

} // namespace fettle::view
