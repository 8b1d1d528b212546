// SPDX-License-Identifier: MIT
#include "bot2nurbs/read_mesh.h"

#include <gtest/gtest.h>

TEST(ReadMesh, a_missing_file_cannot_be_read_and_is_named)
{
    bot2nurbs::Context context;
    const auto soup = bot2nurbs::read_mesh("no/such/file.obj", context);
    ASSERT_FALSE(soup);
    EXPECT_EQ(soup.error().code, bot2nurbs::ErrorCode::cannot_read);
    EXPECT_NE(soup.error().message.find("no/such/file.obj"), std::string::npos);
}
