#include "linespace/contacts/strict_inequalities.h"

#include <span>

namespace sightline::internal::contacts {

namespace {

Ring exact_dot(const Row& p, const Row& q, int dimension) {
  Ring sum(0);
  for (int i = 0; i < dimension; ++i) sum = sum + Ring(p.e[i] * q.e[i]);
  return sum;
}

// Each rounded product is within 5 ulp, the sum of five within 4 more: 12 ulp bounds it
// with the higher orders.
int dot_sign(const Row& p, const Row& q, int dimension) {
  double sum = 0, size = 0;
  for (int i = 0; i < dimension; ++i) {
    const double product = p.r[i] * q.r[i];
    sum += product;
    size += std::abs(product);
  }
  const double bound = 12 * kUnit * size + kUnderflow;
  if (sum > bound) return 1;
  if (sum < -bound) return -1;
  return sign_of(exact_dot(p, q, dimension));
}

int pivot_of(const Row& row, int dimension) {
  int best = -1;
  for (int i = 0; i < dimension; ++i) {
    if (sign_of(row.e[i]) == 0) continue;
    if (best < 0 || std::abs(row.r[i]) > std::abs(row.r[best])) best = i;
  }
  return best;
}

// The row on the hyperplane normal * c = 0, without the pivot's unknown.
Row restricted(const Row& row, const Row& normal, int pivot, int dimension) {
  Row out;
  const bool negative = sign_of(normal.e[pivot]) < 0;
  for (int i = 0, j = 0; i < dimension; ++i) {
    if (i == pivot) continue;
    Ring e = Ring(row.e[i] * normal.e[pivot]) - Ring(row.e[pivot] * normal.e[i]);
    out.e[j++] = negative ? Ring(-e) : e;
  }
  out.round(dimension - 1);
  return out;
}

// Some c with row * c > 0 for all rows.  One row after the other: if the c found so far
// fails the next row, and another c does not, then one on that row's hyperplane is
// positive on the rows before, which is the same question in one unknown less.
// Cost: linear in the rows, times the factorial of the dimension, for rows in random
// order.  (R. Seidel, Small-dimensional linear programming and convex hulls made easy,
// 1991; here without an objective.)
bool positive_point(std::span<const Row> rows, int dimension, Row& c) {
  // Without rows any point does; without unknowns no row can be positive.
  if (rows.empty()) {
    for (int i = 0; i < dimension; ++i) c.e[i] = Ring(1);
    c.round(dimension);
    return true;
  }
  if (dimension == 0) return false;
  // Invariant: c is positive on the rows before n.
  c = rows[0];
  for (std::size_t n = 0; n < rows.size(); ++n) {
    // Nearly always c is positive on row n already.
    if (dot_sign(rows[n], c, dimension) > 0) continue;
    // 1. The same question for the rows before n on the hyperplane of row n.  A row of
    // zeros is positive nowhere.
    const Row& normal = rows[n];
    const int pivot = pivot_of(normal, dimension);
    if (pivot < 0) return false;
    std::vector<Row> reduced;
    reduced.reserve(n);
    for (std::size_t j = 0; j < n; ++j) {
      reduced.push_back(restricted(rows[j], normal, pivot, dimension));
    }
    Row inside;
    if (!positive_point(reduced, dimension - 1, inside)) return false;
    // 2. Its answer in all unknowns, times |normal[pivot]| to stay without quotients: the
    // pivot's unknown is the one that makes normal * on = 0.
    Row on;
    const bool negative = sign_of(normal.e[pivot]) < 0;
    const Ring size = negative ? Ring(-normal.e[pivot]) : normal.e[pivot];
    Ring rest(0);
    for (int i = 0, j = 0; i < dimension; ++i) {
      if (i == pivot) continue;
      rest = rest + Ring(normal.e[i] * inside.e[j]);
      on.e[i] = Ring(size * inside.e[j]);
      ++j;
    }
    on.e[pivot] = negative ? rest : Ring(-rest);
    // 3. Off the hyperplane, to row n's positive side: on + step * normal.  A row before,
    // worth `up` at `on`, loses `-fall` per step, so that the step must stay below
    // up / -fall; the smallest of these is height / loss, and half of it is taken.
    Ring height(0), loss(0);
    for (std::size_t j = 0; j < n; ++j) {
      const Ring fall = exact_dot(rows[j], normal, dimension);
      if (sign_of(fall) >= 0) continue;
      const Ring up = exact_dot(rows[j], on, dimension);
      if (sign_of(loss) == 0 || sign_of(Ring(up * loss) - Ring(height * -fall)) < 0) {
        height = up;
        loss = -fall;
      }
    }
    // Where no row before loses anything, any step does.  The new point is the sum above
    // times 2 loss, which is positive.
    if (sign_of(loss) == 0) height = loss = Ring(1);
    const Ring twice = loss + loss;
    for (int i = 0; i < dimension; ++i) {
      c.e[i] = Ring(twice * on.e[i]) + Ring(height * normal.e[i]);
    }
    c.round(dimension);
    // 4. Rounded to doubles the numbers are shorter, and all that follows is cheaper:
    // kept where the rounded point is positive on all rows so far, too.
    // NaN stands for numbers beyond the range of doubles.
    Row rounded;
    rounded.r = c.r;
    if (!std::isnan(c.r[0])) {
      for (int i = 0; i < dimension; ++i) rounded.e[i] = Ring(c.r[i]);
      if (std::all_of(rows.begin(), rows.begin() + n + 1, [&](const Row& row) {
            return dot_sign(row, rounded, dimension) > 0;
          })) {
        c = rounded;
      }
    }
  }
  return true;
}

}  // namespace

bool feasible(std::vector<Row> rows, std::vector<Row> equalities, int dimension) {
  while (!equalities.empty()) {
    const Row normal = equalities.back();
    equalities.pop_back();
    const int pivot = pivot_of(normal, dimension);
    if (pivot < 0) continue;
    for (std::vector<Row>* part : {&rows, &equalities}) {
      for (Row& row : *part) row = restricted(row, normal, pivot, dimension);
    }
    --dimension;
  }
  Row c;
  return positive_point(rows, dimension, c);
}

}  // namespace sightline::internal::contacts
