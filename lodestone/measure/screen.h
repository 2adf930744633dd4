// From errors in model units to pixels on a screen, and back.
#pragma once

namespace lodestone::measure {

/// A perspective view: `height_px` lines over a vertical field of view. Or an orthographic one.
struct View {
  double height_px = 1080;
  double fov_degrees = 45;     ///< vertical
  double aspect = 16.0 / 9.0;  ///< width over height
  /// Above 0: an orthographic view that is this high, model units. Then `fov_degrees` and distances don't matter:
  ///   pixels = error * height_px / orthographic_height.
  double orthographic_height = 0;
};

/// A length `error` seen square-on at `distance` from the eye covers
///   pixels = error * height_px / (2 * distance * tan(fov / 2)).
/// `distance` is to the surface of the model's bounding sphere, so no part of the model is nearer than it. Model units.
double error_to_pixels(double error, double distance, const View& view = {});

/// The error that covers `pixels` at `distance`: the inverse of the above.
double pixels_to_error(double pixels, double distance, const View& view = {});

/// From this distance on (to the surface of the bounding sphere) `error` covers at most `pixels`. Orthographic: 0 where
/// it does, else infinity.
double switch_distance(double error, double pixels = 1, const View& view = {});

/// Share of the screen's area that a sphere covers whose surface is `distance` away:
///   pi * (height/2 * radius / ((distance + radius) * tan(fov / 2)))^2 / (width * height), at most 1;
/// orthographic: with orthographic_height / 2 for what `radius` is divided by.
double screen_coverage(double radius, double distance, const View& view = {});

}  // namespace lodestone::measure
