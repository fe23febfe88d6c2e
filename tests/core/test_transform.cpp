#include <gtest/gtest.h>

#include "core/transform.h"

namespace mote {
namespace {

TEST(Transform, KeysInterpolateAndHoldOutside)
{
    TransformKey moved{11.0};
    moved.translate = {10.0, 0.0, 0.0};
    const std::vector<TransformKey> keys{TransformKey{1.0}, moved};
    EXPECT_DOUBLE_EQ(evaluate(keys, 0.0).translate.x, 0.0);
    EXPECT_DOUBLE_EQ(evaluate(keys, 6.0).translate.x, 5.0);
    EXPECT_DOUBLE_EQ(evaluate(keys, 99.0).translate.x, 10.0);
}

TEST(Transform, ShutterSeesOnlyWhatMoves)
{
    TransformKey moved{11.0};
    moved.translate = {10.0, 0.0, 0.0};
    const std::vector<TransformKey> keys{TransformKey{1.0}, moved};
    EXPECT_FALSE(over_shutter(keys, 20.0, 20.5).is_moving());
    EXPECT_FALSE(over_shutter(keys, 5.0, 5.0).is_moving());
    const MovingTransform moving = over_shutter(keys, 5.0, 6.0);
    ASSERT_TRUE(moving.is_moving());
    EXPECT_NEAR(moving.at(0.5f).translate.x, 4.5, 1e-12);
    const MovingTransform bent = over_shutter(keys, 10.5, 11.5);
    EXPECT_NEAR(bent.at(0.25f).translate.x, 9.75, 1e-6);
    EXPECT_NEAR(bent.at(1.0f).translate.x, 10.0, 1e-12);
}

TEST(Transform, AnglesRunLinearlySoThatAFullTurnIsSeen)
{
    TransformKey turned{13.0};
    turned.rotate = {0.0, 360.0, 0.0};
    const std::vector<TransformKey> keys{TransformKey{1.0}, turned};
    // A quarter turn about +y carries +x to -z.
    const Vec3d x = evaluate(keys, 4.0).rotate * Vec3d(1.0, 0.0, 0.0);
    EXPECT_NEAR(x.z, -1.0, 1e-12);
    const Vec3d half = over_shutter(keys, 1.0, 13.0).at(0.5f).rotate * Vec3d(1.0, 0.0, 0.0);
    EXPECT_NEAR(half.x, -1.0, 1e-12);
}

TEST(Transform, TurnsAboutXThenYThenZ)
{
    TransformKey key;
    key.rotate = {90.0, 0.0, 90.0};
    // About x: y -> z. About z: z stays.
    const Vec3d y = evaluate({key}, 0.0).rotate * Vec3d(0.0, 1.0, 0.0);
    EXPECT_NEAR(y.z, 1.0, 1e-12);
}

TEST(Transform, MatrixAppliesScaleThenRotationThenTranslation)
{
    Trs trs;
    trs.scale = {2.0, 1.0, 1.0};
    trs.rotate = glm::angleAxis(glm::radians(90.0), Vec3d(0.0, 0.0, 1.0));
    trs.translate = {0.0, 0.0, 3.0};
    const Vec3 p = to_affine(matrix(trs)).point({1.0f, 0.0f, 0.0f});
    EXPECT_NEAR(p.x, 0.0f, 1e-6f);
    EXPECT_NEAR(p.y, 2.0f, 1e-6f);
    EXPECT_NEAR(p.z, 3.0f, 1e-6f);
}

}  // namespace
}  // namespace mote
