// Arithmetic notation for building colour expressions: scalars and triples of values over one ExpressionBuilder. The
// formulas of src/physics take them as they take floats.
#pragma once
#include "color/expression/program.h"

namespace relook {

struct Scalar {
  ExpressionBuilder* builder;
  Value value;
};
inline Scalar operator+(Scalar a, Scalar b) { return {a.builder, a.builder->apply(Op::add, a.value, b.value)}; }
inline Scalar operator-(Scalar a, Scalar b) { return {a.builder, a.builder->apply(Op::subtract, a.value, b.value)}; }
inline Scalar operator*(Scalar a, Scalar b) { return {a.builder, a.builder->apply(Op::multiply, a.value, b.value)}; }
inline Scalar operator/(Scalar a, Scalar b) { return {a.builder, a.builder->apply(Op::divide, a.value, b.value)}; }
inline Scalar number(Scalar like, float x) { return {like.builder, like.builder->constant(x)}; }
inline Scalar operator+(Scalar a, float b) { return a + number(a, b); }
inline Scalar operator+(float a, Scalar b) { return number(b, a) + b; }
inline Scalar operator-(Scalar a, float b) { return a - number(a, b); }
inline Scalar operator-(float a, Scalar b) { return number(b, a) - b; }
inline Scalar operator*(Scalar a, float b) { return a * number(a, b); }
inline Scalar operator/(Scalar a, float b) { return a / number(a, b); }
inline Scalar operator/(float a, Scalar b) { return number(b, a) / b; }
inline Scalar min(Scalar a, Scalar b) { return {a.builder, a.builder->apply(Op::min, a.value, b.value)}; }
inline Scalar max(Scalar a, Scalar b) { return {a.builder, a.builder->apply(Op::max, a.value, b.value)}; }
inline Scalar min(Scalar a, float b) { return min(a, number(a, b)); }
inline Scalar max(Scalar a, float b) { return max(a, number(a, b)); }
inline Scalar sqrt(Scalar a) { return {a.builder, a.builder->apply(Op::sqrt, a.value)}; }
inline Scalar exp2(Scalar a) { return {a.builder, a.builder->apply(Op::exp2, a.value)}; }
inline Scalar log2(Scalar a) { return {a.builder, a.builder->apply(Op::log2, a.value)}; }
/// cos(2 pi a)
inline Scalar cos_turns(Scalar a) { return {a.builder, a.builder->apply(Op::cos_turns, a.value)}; }
/// condition > 0 ? a : b
inline Scalar if_positive(Scalar condition, Scalar a, Scalar b) {
  return {a.builder, a.builder->apply(Op::if_positive, condition.value, a.value, b.value)};
}

/// The table of physics/sheen.h.
inline Scalar sheen_albedo(Scalar cosine, Scalar roughness) {
  return {cosine.builder, cosine.builder->apply(Op::sheen_albedo, cosine.value, roughness.value)};
}

struct Triple {
  Scalar x, y, z;
};
inline Triple operator+(Triple a, Triple b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Triple operator-(Triple a, Triple b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Triple operator*(Triple a, Triple b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Triple operator*(Triple a, Scalar s) { return {a.x * s, a.y * s, a.z * s}; }
inline Triple operator*(Triple a, float s) { return a * number(a.x, s); }
inline Scalar dot(Triple a, Triple b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Scalar largest(Triple a) { return max(max(a.x, a.y), a.z); }
inline Triple normalized(Triple a) { return a * (1.0F / sqrt(max(dot(a, a), 1e-30F))); }
inline Triple if_positive(Scalar condition, Triple a, Triple b) {
  return {if_positive(condition, a.x, b.x), if_positive(condition, a.y, b.y), if_positive(condition, a.z, b.z)};
}

}  // namespace relook
