#include "linespace/picture/picture_point.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "linespace/picture/classes.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {

PicturePoint::PicturePoint(const EyeSpace& eye, int point) : eye_(&eye), point_(point) {
  set(eye.vector(point), 0x1p-62L);
}

PicturePoint::PicturePoint(const EyeSpace& eye, int line, const LineCut& cut)
    : eye_(&eye) {
  const auto [a, b] = eye.scene().lines()[line].ends;
  if (cut.kind == LineCut::Kind::Start || cut.kind == LineCut::Kind::Finish) {
    point_ = cut.kind == LineCut::Kind::Start ? a : b;
    set(eye.vector(point_), 0x1p-62L);
    return;
  }
  line_ = line;
  cut_ = cut;
  const LongVector& u = eye.vector(a);
  const LongVector& v = eye.vector(b);
  LongVector w;
  long double size = 0, length = 0;
  for (int i = 0; i < 3; ++i) {
    w[i] = (cut.w1 * u[i] + cut.w0 * v[i]) / (cut.w0 + cut.w1);
    size = std::max({size, std::abs(u[i]), std::abs(v[i])});
    length = std::max(length, std::abs(u[i] - v[i]));
  }
  set(w, 0x1p-61L);
  // The position's own error, and what cancels between u and v.
  long double norm = 1;
  if (!eye.is_direction()) norm = std::sqrt(dot(w, w));
  error_ += (cut.error * length + 0x1p-60L * size) / norm;
  // On a line that passes very near the eye all cancels: the vector would be any.
  constexpr long double kUsable = 0x1p-20L;
  if (error_ < kUsable || thread_precision == Precision::Double) return;
  const ExactPoint& x = exact();
  const Rational longest = std::max({abs(x[0]), abs(x[1]), abs(x[2])});
  if (longest == 0) return;
  for (int i = 0; i < 3; ++i) w[i] = long_double(Rational(x[i] / longest));
  set(w, 0x1p-60L);
}

PicturePoint::PicturePoint(const EyeSpace& eye, const ExactPoint& vector)
    : eye_(&eye), exact_(std::make_shared<const ExactPoint>(vector)) {
  set({long_double(vector[0]), long_double(vector[1]), long_double(vector[2])}, 0x1p-60L);
}

void PicturePoint::set(const LongVector& v, long double relative_error) {
  const long double scale = eye_->is_direction() ? 1 / v[2] : 1 / std::sqrt(dot(v, v));
  long double size = 0;
  for (int i = 0; i < 3; ++i) {
    vector_[i] = v[i] * scale;
    size = std::max(size, std::abs(vector_[i]));
  }
  error_ = 2 * relative_error * size;
}

const ExactPoint& PicturePoint::exact() const {
  if (point_ >= 0) return eye_->exact_vector(point_);
  if (!exact_) {
    const auto [a, b] = eye_->scene().lines()[line_].ends;
    const Rational t = LineCuts(*eye_, line_).exact(cut_);
    exact_ = std::make_shared<const ExactPoint>(
        along(eye_->exact_vector(a), eye_->exact_vector(b), t));
  }
  return *exact_;
}

Sign orient(const PicturePoint& p, const PicturePoint& q, const PicturePoint& r) {
  const LongVector &u = p.vector(), &v = q.vector(), &w = r.vector();
  LongVector dv, dw;
  long double size = 0, size_v = 0, size_w = 0;
  for (int i = 0; i < 3; ++i) {
    dv[i] = v[i] - u[i];
    dw[i] = w[i] - u[i];
    size = std::max(size, std::abs(u[i]));
    size_v = std::max(size_v, std::abs(dv[i]));
    size_w = std::max(size_w, std::abs(dw[i]));
  }
  const long double value = dot(u, cross(dv, dw));
  // Six terms |u| |dv| |dw|, each with the errors of its factors and eight roundings.
  const long double ev = p.error() + q.error(), ew = p.error() + r.error();
  const long double error =
      6 * (size * (size_v * ew + ev * (size_w + ew)) + p.error() * size_v * size_w +
           0x1p-60L * size * size_v * size_w);
  if (std::abs(value) > error || thread_precision == Precision::Double) {
    ++thread_stage_counts().by_double;
    return static_cast<Sign>((value > 0) - (value < 0));
  }
  ++thread_stage_counts().by_exact;
  return static_cast<Sign>(
      exact_dot(p.exact(), exact_cross(q.exact(), r.exact())).sign());
}

bool same_point(const PicturePoint& p, const PicturePoint& q) {
  if (p.point() >= 0 && p.point() == q.point()) return true;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(p.vector()[i] - q.vector()[i]) > p.error() + q.error()) return false;
  }
  return exact_cross(p.exact(), q.exact()) == ExactPoint{};
}

std::vector<int> number_points(std::span<const PicturePoint> points) {
  // A linear function hardly ever takes one value at two points: only points with nearly
  // the same value can be one.
  std::vector<std::pair<long double, int>> keys;
  long double widest = 0;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const LongVector& v = points[i].vector();
    keys.emplace_back(0.5377L * v[0] + 0.8339L * v[1] + 0.1259L * v[2], i);
    widest = std::max(widest, points[i].error());
  }
  std::ranges::sort(keys);
  Classes classes(points.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    hear_stop();
    for (std::size_t j = i + 1; j < keys.size(); ++j) {
      if (keys[j].first - keys[i].first > 4 * widest + 0x1p-58L) break;
      const int x = keys[i].second, y = keys[j].second;
      if (classes.root(x) != classes.root(y) && same_point(points[x], points[y]))
        classes.join(x, y);
    }
  }
  std::vector<int> numbers;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    numbers.push_back(classes.root(i));
  }
  return numbers;
}

}  // namespace sightline::internal
