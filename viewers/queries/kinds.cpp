#include "viewers/kinds.h"

namespace sightline::viewers {

std::string kind_name(const SkeletonArc& arc) {
  const std::string name = arc.is_ev() ? "EV" : "EEE";
  return arc.self ? name + "_self" : name;
}

std::string kind_name(const SkeletonNode& node) {
  std::string name;
  switch (node.kind) {
    case NodeKind::VV:
      name = "VV";
      break;
    case NodeKind::VEE:
      name = "VEE";
      break;
    case NodeKind::EVE:
      name = "EVE";
      break;
    case NodeKind::FvE:
      name = "FvE";
      break;
    case NodeKind::EEEE:
      name = "EEEE";
      break;
    case NodeKind::FEE:
      name = "FEE";
      break;
    case NodeKind::FF:
      name = "FF";
      break;
    case NodeKind::Saddle:
      name = "saddle";
      break;
    case NodeKind::Pierce:
      name = "pierce";
      break;
    case NodeKind::Degenerate:
      return "degenerate";
  }
  return node.self ? name + "_self" : name;
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const bool self : {false, true}) {
    for (const ArcKind kind : {ArcKind::EV, ArcKind::EEE}) {
      names.push_back(kind_name(SkeletonArc{.kind = kind, .self = self}));
    }
  }
  for (const bool self : {false, true}) {
    for (const NodeKind kind :
         {NodeKind::VV, NodeKind::VEE, NodeKind::EVE, NodeKind::FvE, NodeKind::EEEE,
          NodeKind::FEE, NodeKind::FF, NodeKind::Saddle, NodeKind::Pierce}) {
      SkeletonNode node{};
      node.kind = kind;
      node.self = self;
      names.push_back(kind_name(node));
    }
  }
  names.emplace_back("degenerate");
  return names;
}

}  // namespace sightline::viewers
