#include "linespace/between/cover_writer.h"

#include <cmath>

namespace sightline::internal {

void CoverWriter::node(const CoverNode& node) {
  if (keep_) cover_.nodes.push_back(node);
}

void CoverWriter::blocked(int blocker) {
  if (!keep_) return;
  const Blocker& b = space_.blockers()[blocker];
  if (b.halves[0] < 0) return node({CoverNode::Kind::Blocked, 0, blocker, 0});
  const auto [form, sign] = b.shared;
  if (path_.sign[form] != 0) return blocked(b.halves[path_.sign[form] == sign ? 0 : 1]);
  node({CoverNode::Kind::Split, sign, form, 0});
  for (const int half : {0, 1}) {
    path_.sign[form] = static_cast<std::int8_t>(half == 0 ? sign : -sign);
    blocked(b.halves[half]);
  }
  path_.sign[form] = 0;
}

void CoverWriter::empty(const std::vector<CoverShare>& shares) {
  if (!keep_) return;
  node({CoverNode::Kind::Empty, 0, static_cast<std::int32_t>(cover_.shares.size()),
        static_cast<std::int32_t>(shares.size())});
  for (CoverShare share : shares) {
    const int exponent = -space_.exponent(share.form) -
                         (share.other >= 0 ? space_.exponent(share.other) : 0);
    share.weight = std::ldexp(share.weight, exponent);
    if (share.exact >= 0) scale(cover_.exact_weights[share.exact], exponent);
    cover_.shares.push_back(share);
  }
}

int CoverWriter::exact_weight(const Rational& weight) {
  cover_.exact_weights.push_back(weight);
  return static_cast<int>(cover_.exact_weights.size()) - 1;
}

void scale(Rational& x, int exponent) {
  const Rational power(boost::multiprecision::mpz_int(1) << std::abs(exponent));
  x = exponent > 0 ? Rational(x * power) : Rational(x / power);
}

}  // namespace sightline::internal
