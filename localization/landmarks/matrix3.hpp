#pragma once

namespace madori::localization::landmarks {

/// Three numbers (x, y, yaw).
struct Vector3 {
  double v[3] = {0.0, 0.0, 0.0};

  [[nodiscard]] double operator[](int i) const { return v[i]; }
  double& operator[](int i) { return v[i]; }
};

[[nodiscard]] inline Vector3 operator+(const Vector3& a, const Vector3& b) {
  return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}};
}
[[nodiscard]] inline Vector3 operator-(const Vector3& a, const Vector3& b) {
  return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}
[[nodiscard]] inline Vector3 operator*(double s, const Vector3& a) {
  return {{s * a[0], s * a[1], s * a[2]}};
}
[[nodiscard]] inline double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// 3 x 3, rows first. Small enough for a controller; no allocation, no library.
struct Matrix3 {
  double m[3][3] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};

  [[nodiscard]] static Matrix3 diagonal(double a, double b, double c) {
    return {{{a, 0.0, 0.0}, {0.0, b, 0.0}, {0.0, 0.0, c}}};
  }
  [[nodiscard]] double operator()(int row, int column) const { return m[row][column]; }
  double& operator()(int row, int column) { return m[row][column]; }
};

[[nodiscard]] inline Matrix3 operator+(const Matrix3& a, const Matrix3& b) {
  Matrix3 sum;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum(i, j) = a(i, j) + b(i, j);
  return sum;
}
[[nodiscard]] inline Matrix3 operator*(double s, const Matrix3& a) {
  Matrix3 product;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) product(i, j) = s * a(i, j);
  return product;
}
[[nodiscard]] inline Matrix3 operator-(const Matrix3& a, const Matrix3& b) {
  return a + (-1.0) * b;
}
[[nodiscard]] inline Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
  Matrix3 product;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) product(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  return product;
}
[[nodiscard]] inline Vector3 operator*(const Matrix3& a, const Vector3& b) {
  return {{a(0, 0) * b[0] + a(0, 1) * b[1] + a(0, 2) * b[2], a(1, 0) * b[0] + a(1, 1) * b[1] + a(1, 2) * b[2],
           a(2, 0) * b[0] + a(2, 1) * b[1] + a(2, 2) * b[2]}};
}
[[nodiscard]] inline Matrix3 transposed(const Matrix3& a) {
  Matrix3 t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t(i, j) = a(j, i);
  return t;
}
/// A symmetric matrix in other axes: j * a * j'.
[[nodiscard]] inline Matrix3 carried(const Matrix3& j, const Matrix3& a) {
  return j * a * transposed(j);
}
[[nodiscard]] inline Matrix3 symmetric(const Matrix3& a) {
  return 0.5 * (a + transposed(a));
}
/// By cofactors; `a` must be regular.
[[nodiscard]] inline Matrix3 inverse(const Matrix3& a) {
  Matrix3 adjoint;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int p = (j + 1) % 3, q = (j + 2) % 3, r = (i + 1) % 3, s = (i + 2) % 3;
      adjoint(i, j) = a(p, r) * a(q, s) - a(p, s) * a(q, r);
    }
  const double determinant = a(0, 0) * adjoint(0, 0) + a(0, 1) * adjoint(1, 0) + a(0, 2) * adjoint(2, 0);
  return (1.0 / determinant) * adjoint;
}

}  // namespace madori::localization::landmarks
