#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

namespace tartan_calib::test_support {

/// Expects `call` to throw Error with one line that contains every one of `parts`.
template <typename Error, typename Call>
void expectMessage(const Call& call, std::initializer_list<std::string> parts) {
  try {
    call();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& part : parts) {
      EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
    }
  }
}

}  // namespace tartan_calib::test_support
