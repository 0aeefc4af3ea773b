// Role names over Imath: what transforms differently has a different name. All lengths in metres, angles in radians,
// colours linear Rec.709. Points are relative to the camera's eye or to an object, unless they are wide. Imath
// multiplies row vectors: `point * matrix`.
#pragma once
#include <ImathBox.h>
#include <ImathColor.h>
#include <ImathMatrix.h>
#include <ImathVec.h>

namespace relook {

using Point = Imath::V3f;
using Direction = Imath::V3f;
using Normal = Imath::V3f;
using Uv = Imath::V2f;
using Color = Imath::C3f;  // linear RGB
using Rgba = Imath::C4f;   // linear RGB, coverage
using Transform = Imath::M44f;
using Box = Imath::Box3f;
// Places and boxes in the world, where floats would not do.
using WidePoint = Imath::V3d;
using WideBox = Imath::Box3d;

}  // namespace relook
