// Small vectors. Plain structs; float for storage, double for arithmetic that must be right.
#pragma once

#include <cmath>
#include <cstddef>

namespace lodestone {

template <class T>
struct Vec2 {
  T x{}, y{};
  friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  constexpr T& operator[](std::size_t i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr const T& operator[](std::size_t i) const { return i == 0 ? x : i == 1 ? y : z; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(Vec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(T s, Vec3 a) { return a * s; }
  friend constexpr Vec3 operator/(Vec3 a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
  constexpr Vec3& operator-=(Vec3 b) { return *this = *this - b; }
  constexpr Vec3& operator*=(T s) { return *this = *this * s; }
};

using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
constexpr T length_sq(Vec3<T> a) {
  return dot(a, a);
}
template <class T>
T length(Vec3<T> a) {
  return std::sqrt(dot(a, a));
}
/// Unit vector; the zero vector stays zero.
template <class T>
Vec3<T> normalized(Vec3<T> a) {
  const T l = length(a);
  return l > T(0) ? a / l : Vec3<T>{};
}
template <class T>
constexpr Vec3<T> lerp(Vec3<T> a, Vec3<T> b, T t) {
  return a + (b - a) * t;
}

constexpr Vec3d to_double(Vec3f a) { return {double(a.x), double(a.y), double(a.z)}; }
constexpr Vec3f to_float(Vec3d a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

template <class T>
bool is_finite(Vec3<T> a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

}  // namespace lodestone
