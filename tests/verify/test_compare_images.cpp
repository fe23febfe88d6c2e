#include <limits>

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "verify/compare_images.h"
#include "verify/difference_image.h"

namespace mote {

namespace {

using Names = std::vector<std::string>;

LayeredImage image_of(const Names& channels, float value = 1.0f, int width = 2, int height = 2)
{
    LayeredImage image;
    image.width = width;
    image.height = height;
    for (const std::string& name : channels) {
        image.channels.push_back({name, PixelType::Float, Buffer2D<float>(width, height, value)});
    }
    return image;
}

std::vector<LayerMetrics> compare(const LayeredImage& a, const LayeredImage& b,
                                  const Names& layers = {})
{
    return compare_images({a, "a.exr"}, {b, "b.exr"}, layers, {});
}

const Names all_channels{"A",          "B",         "G",          "R",
                         "Z",          "samples.Y", "variance.B", "variance.G",
                         "variance.R", "volume.B",  "volume.G",   "volume.R"};

}  // namespace

TEST(CompareImages, GroupsChannelsAsPeopleReadThem)
{
    const auto layers = compare(image_of(all_channels), image_of(all_channels));
    Names found;
    for (const LayerMetrics& layer : layers) {
        for (const ChannelMetrics& channel : layer.channels) found.push_back(channel.name);
    }
    EXPECT_EQ(found, (Names{"R", "G", "B", "A", "Z", "volume.R", "volume.G", "volume.B"}));
    EXPECT_EQ(layers[0].name, "rgb");
    EXPECT_EQ(layers[1].name, "alpha");
    EXPECT_EQ(layers[3].name, "volume");
    EXPECT_TRUE(layers[0].channels[0].noise);
    EXPECT_FALSE(layers[3].channels[0].noise);
}

TEST(CompareImages, ALayersFiguresAreMeansOverItsChannels)
{
    const LayeredImage reference = image_of({"R", "G", "B"}, 1.0f);
    LayeredImage tested = reference;
    for (float& value : tested.channels[1].data) value = 4.0f;
    const auto layers = compare(tested, reference);
    EXPECT_DOUBLE_EQ(layers[0].mse, 3.0);
    EXPECT_DOUBLE_EQ(layers[0].rel_mse, 3.0 / 1.01);
}

TEST(CompareImages, RefusesWhatDoesNotMatch)
{
    const LayeredImage rgb = image_of({"R", "G", "B"});
    const LayeredImage more = image_of({"R", "G", "B", "Z", "volume.R"});
    expect_error(
        [&] {
            compare(rgb, image_of({"R", "G", "B"}, 1.0f, 3, 2));
        },
        ExitCode::Input, {"a.exr has 2 x 2 pixels but b.exr has 3 x 2"});
    expect_error([&] { compare(rgb, more); }, ExitCode::Input,
                 {"a.exr lacks layers that b.exr has: Z,volume", "--layers rgb"});
    expect_error([&] { compare(more, rgb); }, ExitCode::Input,
                 {"b.exr lacks layers that a.exr has: Z,volume", "--layers rgb"});
    expect_error([&] { compare(more, more, {"volme"}); }, ExitCode::Input,
                 {"no layer \"volme\"", "did you mean \"volume\"", "rgb,Z,volume"});
    expect_error(
        [&] {
            compare(rgb, image_of({"R", "G"}));
        },
        ExitCode::Input, {"b.exr has no channel \"B\", which a.exr has"});
    expect_error(
        [&] {
            compare(image_of({"R", "G"}), rgb);
        },
        ExitCode::Input, {"a.exr has no channel \"B\", which b.exr has"});
    expect_error([&] { compare(image_of({"X"}), rgb); }, ExitCode::Input, {"none in common"});
    EXPECT_EQ(compare(more, rgb, {"rgb"}).size(), 1u);
}

TEST(CompareImages, AReferenceMayHaveAVarianceAlone)
{
    const auto layers = compare(image_of({"R"}), image_of({"R", "variance.R", "samples.Y"}));
    ASSERT_EQ(layers.size(), 1u);
    EXPECT_TRUE(layers[0].channels[0].noise);
}

TEST(DifferenceImage, HoldsSignedDifferencesOfTheComparedChannels)
{
    LayeredImage tested = image_of({"R", "Z"}, 1.0f);
    LayeredImage reference = image_of({"R", "Z"}, 3.0f);
    tested.channels[0].data.at(0, 0) = std::numeric_limits<float>::infinity();
    reference.channels[0].data.at(0, 0) = std::numeric_limits<float>::infinity();
    const LayeredImage difference =
        difference_image(tested, reference, compare(tested, reference, {"rgb"}));
    ASSERT_EQ(difference.channels.size(), 1u);
    EXPECT_EQ(difference.find("R")->data.at(0, 0), 0.0f);
    EXPECT_EQ(difference.find("R")->data.at(1, 1), -2.0f);
}

TEST(DifferenceImage, ColoursSayTheSign)
{
    const LayeredImage reference = image_of({"R"}, 1.0f);
    LayeredImage tested = reference;
    tested.channels[0].data.at(1, 0) = 2.0f;
    tested.channels[0].data.at(0, 1) = 0.0f;
    tested.channels[0].data.at(1, 1) = std::numeric_limits<float>::quiet_NaN();
    const auto picture = false_colour(tested, reference, compare(tested, reference)[0], 2.0);
    EXPECT_EQ(picture.at(0, 0), Spectrum(1.0f));
    // Mean reference over the finite pixels 1: the relative difference is 1/sqrt(1.01).
    const float faded = 1.0f - 0.5f / std::sqrt(1.01f);
    EXPECT_NEAR(picture.at(1, 0).y, faded, 1e-6f);
    EXPECT_EQ(picture.at(1, 0).x, 1.0f);
    EXPECT_NEAR(picture.at(0, 1).x, faded, 1e-6f);
    EXPECT_EQ(picture.at(0, 1).z, 1.0f);
    EXPECT_GT(picture.at(1, 1).y, picture.at(1, 1).x);
}

}  // namespace mote
