#pragma once

#include <ros/node_handle.h>

#include <set>
#include <string>
#include <vector>

namespace tartan_calib::apps {

/// The private parameters of a node. Failures throw UsageError that names the parameter.
class Parameters {
 public:
  explicit Parameters(const ::ros::NodeHandle& private_node) : node_(private_node) {}

  /// A required text.
  std::string text(const std::string& name);
  std::string text(const std::string& name, const std::string& fallback);

  /// A list of texts, or one text with blanks between the words, as launch files pass it.
  std::vector<std::string> words(const std::string& name);
  /// The fallback also stands for a list without words.
  std::vector<std::string> words(const std::string& name, const std::vector<std::string>& fallback);

  /// An integer may stand for it. Within [lowest, highest].
  double number(const std::string& name, double fallback, double lowest, double highest);

  /// Throws for a parameter of the node that nothing asked for: a misspelt one.
  void checkAllKnown() const;

 private:
  ::ros::NodeHandle node_;
  std::set<std::string> known_;
};

}  // namespace tartan_calib::apps
