// SPDX-License-Identifier: Apache-2.0
// Angles of known accuracy: Vulkan allows 4096 ulp in atan, which is several rays of a fine pattern.
#ifndef VANTAGE_LIB_ANGLES
#define VANTAGE_LIB_ANGLES

const float pi = 3.14159265358979;
const float angle_slack = 1e-5;  // bounds the error of angle_of, and of turning angles into rays, generously

// Returns atan2 within 1e-6. atan(x) / x on [0, 1] is a polynomial of degree 9 in x², interpolated at Chebyshev nodes
// (error below 1e-7).
float angle_of(float y, float x) {
  const float ax = abs(x), ay = abs(y);
  const float larger = max(ax, ay);
  if (larger == 0.0) return 0.0;
  const float q = min(ax, ay) / larger, z = q * q;
  float s = -0.00170117007;
  s = s * z + 0.01048764927;
  s = s * z - 0.03035186482;
  s = s * z + 0.05708955597;
  s = s * z - 0.08349724971;
  s = s * z + 0.10932341502;
  s = s * z - 0.14260016083;
  s = s * z + 0.19998075281;
  s = s * z - 0.33333276292;
  s = s * z + 0.99999999716;
  float a = s * q;
  if (ay > ax) a = 0.5 * pi - a;
  if (x < 0.0) a = pi - a;
  return y < 0.0 ? -a : a;
}

#endif
