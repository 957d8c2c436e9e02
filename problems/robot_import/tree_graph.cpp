#include "downwash/robot_import/tree_graph.hpp"

#include <map>
#include <string>
#include <vector>

#include "downwash/base/text.hpp"

namespace downwash::robot_import {
namespace {

std::string quoted(const std::string& name) {
    return "'" + excerpt(name) + "'";
}

template <class Parts>
void check_names(const Parts& parts, const char* what, Findings& findings) {
    std::map<std::string, Place> seen;
    for (const auto& part : parts) {
        if (part.name.empty()) {
            findings.error(part.place, std::string("this ") + what + " has no name: expected name=\"...\"");
        } else if (const auto [first, is_new] = seen.emplace(part.name, part.place); !is_new) {
            findings.error(part.place, std::string("there are two ") + what + "s named " + quoted(part.name) +
                                           ", the first in line " + std::to_string(first->second.line) +
                                           ": expected a name of its own for each");
        }
    }
}

}  // namespace

int require_tree(const KinematicTree& tree, Findings& findings) {
    check_names(tree.links, "link", findings);
    check_names(tree.joints, "joint", findings);
    if (tree.links.empty()) {
        findings.fail({}, "has no links: expected a robot with at least one");
    }
    std::vector<int> parent_joint(tree.links.size(), -1);
    for (std::size_t j = 0; j < tree.joints.size(); ++j) {
        int& hangs_by = parent_joint[static_cast<std::size_t>(tree.joints[j].child)];
        if (hangs_by >= 0) {
            findings.error(tree.joints[j].place,
                           "joint " + quoted(tree.joints[j].name) + " closes a loop: link " +
                               quoted(tree.links[static_cast<std::size_t>(tree.joints[j].child)].name) +
                               " hangs on joint " + quoted(tree.joints[static_cast<std::size_t>(hangs_by)].name) +
                               " already; expected each link to be the child of one joint: leave out one of them");
        } else {
            hangs_by = static_cast<int>(j);
        }
    }
    findings.throw_if_any();
    std::vector<int> bases;
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
        int link = static_cast<int>(i);
        std::size_t steps = 0;
        while (parent_joint[static_cast<std::size_t>(link)] >= 0 && steps <= tree.links.size()) {
            link = tree.joints[static_cast<std::size_t>(parent_joint[static_cast<std::size_t>(link)])].parent;
            ++steps;
        }
        if (steps > tree.links.size()) {
            findings.fail(tree.links[i].place, "link " + quoted(tree.links[i].name) +
                                                   " hangs on itself, over the joints before it: expected a tree that "
                                                   "begins at one base");
        }
        if (parent_joint[i] < 0) {
            bases.push_back(static_cast<int>(i));
        }
    }
    for (std::size_t i = 1; i < bases.size(); ++i) {
        const TreeLink& link = tree.links[static_cast<std::size_t>(bases[i])];
        findings.error(link.place, "link " + quoted(link.name) + " hangs on nothing, as does " +
                                       quoted(tree.links[static_cast<std::size_t>(bases[0])].name) +
                                       ": expected one base; connect them by a fixed joint or leave one out");
    }
    findings.throw_if_any();
    return bases.front();
}

}  // namespace downwash::robot_import
