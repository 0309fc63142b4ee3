#pragma once

namespace hypotrack::rgbd_depth {

/// What was observed at a pixel is one number: z of the foreground in metres, or one of these.
/// They lie farther from any depth than depths are compared.
inline constexpr float kUnmeasured = -1e6f;  ///< foreground without a depth
inline constexpr float kBackground = -2e6f;  ///< not foreground, whatever its depth
inline constexpr float kOutside = -3e6f;     ///< outside the image: nobody looked there

}  // namespace hypotrack::rgbd_depth
