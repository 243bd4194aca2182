#pragma once

// For the files of this module alone.

#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

#include <Eigen/Core>

namespace fettle::cad {

inline Eigen::Vector3d vector_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }
inline Eigen::Vector3d vector_of(const gp_Vec& v) { return {v.X(), v.Y(), v.Z()}; }

} // namespace fettle::cad
