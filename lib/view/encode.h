#pragma once

#include "draw/field_scale.h"
#include "mesh/cloud_mesh.h"
#include "json/document.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace fettle::view {

/// A field of a layer as it is shown.
struct ShownField {
    std::string name;         ///< z, a field of the points, class or rgb
    Eigen::VectorXd numbers;  ///< of the points, in the units of the page; NaN: undefined
    draw::PictureScale scale; ///< colours
    json::Value description;  ///< what else the page needs of it; encode_layer() adds its quantisation
};

/// A layer of a page, packed.
struct EncodedLayer {
    json::Value description; ///< members count, triangles, origin, step, spacing, normals, fields
    std::string block;       ///< deflated bytes in base64
};

/// Packs the points of a layer. Coordinates and values become integers of 16 bits: coordinates over the box of the
/// points, values from their minimum to their maximum, 65535 for undefined ones; normals become two bytes each
/// (octahedral; Meyer et al. 2010, "On floating-point normal vectors"). Points follow a Morton curve, each column is
/// written as differences from the one before, low bytes before high bytes, which zlib then packs well: a million
/// points with normals and errors take about 8 MB. Triangles follow the points; a corner is written as its distance
/// from the next new one. Points that are not finite are left out.
/// @param mm  millimetres per unit of the page
EncodedLayer encode_layer(const mesh::CloudMesh& part, const std::vector<ShownField>& fields, double mm);

} // namespace fettle::view
