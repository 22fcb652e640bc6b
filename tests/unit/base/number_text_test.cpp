// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/text.h"

#include <gtest/gtest.h>

namespace lanthorn::number_text_test {

TEST(Text, NumbersInMessagesAreShort) {
  EXPECT_EQ(short_number(0), "0");
  EXPECT_EQ(short_number(0.00123), "0.0012");
  EXPECT_EQ(short_number(1.94), "1.9");
  EXPECT_EQ(short_number(12.3), "12");
  EXPECT_EQ(short_number(99.4), "99");
  EXPECT_EQ(short_number(99.6), "100");
  EXPECT_EQ(short_number(100), "100");
  EXPECT_EQ(short_number(-12345.4), "-12345");
  EXPECT_EQ(short_number(2.34e7), "2.3e+07");
}

}  // namespace lanthorn::number_text_test
