#pragma once

#include "find/image.h"

namespace fettle::find {

/// Robust Gaussian regression filter of order 2 (ISO 16610-31 and -71; Zeng, Jiang & Scott 2010): at each cell a
/// quadratic fitted under a Gaussian window, iterated with Tukey's weights, which are lower above the surface than
/// beneath it. It follows form up to the window's width and passes beneath what is narrower.
/// @param z      heights, mm   @param trusted  cells that weigh fully at first; others weigh a hundredth
/// @param sigma  of the noise, mm   @param width  of the window, cells; what is narrower stays in the residual
/// @return  mm; cells that are seen have a value, others may have none
Image regression_filter(const Image& z, const Mask& trusted, double sigma, double width);

/// Grey-scale opening by a ball (Sternberg 1986; ISO 16610-41 and -49): the surface that a ball touches from beneath.
/// Features narrower than the ball's cap remain in the residual, on a surface of any form, and so do two or three
/// standard deviations of noise.
/// @param z  mm   @param cell  mm   @param width  of the cap, cells
/// @return  mm, without gaps
Image ball_opening(const Image& z, double cell, double width);

} // namespace fettle::find
