#include "hud/hud.h"

#include <imgui.h>

#include <cmath>
#include <filesystem>

#include "core/check.h"

namespace cathlab {

struct Hud::Impl {
    float scale = 1;
    ImGuiContext* context = nullptr;
    std::shared_ptr<const DrawAtlas> atlas;
};

Hud::Hud(float scale, const std::string& font_file) : impl_(std::make_unique<Impl>()) {
    CATHLAB_CHECK(scale >= 0.5F && scale <= 4.0F, "HUD scale out of [0.5, 4]");
    impl_->scale = scale;
    impl_->context = ImGui::CreateContext();
    ImGui::SetCurrentContext(impl_->context);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.DeltaTime = 1.0F / 60.0F;

    const std::string file = font_file.empty() ? "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf" : font_file;
    ImFont* font = nullptr;
    // Sixteen pixels is the tallest text of the panels; smaller text is the same glyphs shrunk.
    if (std::filesystem::is_regular_file(file)) {
        ImFontConfig config;
        config.OversampleH = 3;
        config.OversampleV = 2;
        font = io.Fonts->AddFontFromFileTTF(file.c_str(), std::round(16.0F * scale), &config);
    }
    if (font == nullptr) io.Fonts->AddFontDefault();
    unsigned char* pixels = nullptr;
    DrawAtlas atlas;
    io.Fonts->GetTexDataAsAlpha8(&pixels, &atlas.width, &atlas.height);
    const auto size = static_cast<std::size_t>(atlas.width) * static_cast<std::size_t>(atlas.height);
    atlas.alpha.assign(pixels, pixels + size);
    impl_->atlas = std::make_shared<const DrawAtlas>(std::move(atlas));
    ImGui::StyleColorsDark();
}

Hud::~Hud() {
    ImGui::DestroyContext(impl_->context);
}

float Hud::scale() const {
    return impl_->scale;
}

void Hud::draw(const HudData& data, HudLayout layout, HudDrawList& out) {
    ImGui::SetCurrentContext(impl_->context);
    ImGui::GetIO().DisplaySize = ImVec2(layout.width, layout.height);
    layout.scale = impl_->scale;
    ImGui::NewFrame();
    draw_panels(data, layout);
    ImGui::Render();

    out.width = layout.width;
    out.height = layout.height;
    out.atlas = impl_->atlas;
    out.vertices.clear();
    out.indices.clear();
    out.commands.clear();
    const ImDrawData* drawn = ImGui::GetDrawData();
    for (int i = 0; i < drawn->CmdListsCount; ++i) {
        const ImDrawList* list = drawn->CmdLists[i];
        const auto first_vertex = static_cast<std::uint32_t>(out.vertices.size());
        const auto first_index = static_cast<std::uint32_t>(out.indices.size());
        for (const ImDrawVert& v : list->VtxBuffer) {
            out.vertices.push_back({v.pos.x, v.pos.y, v.uv.x, v.uv.y, v.col});
        }
        for (const ImDrawIdx index : list->IdxBuffer) out.indices.push_back(first_vertex + index);
        for (const ImDrawCmd& command : list->CmdBuffer) {
            if (command.ElemCount == 0 || command.UserCallback != nullptr) continue;
            out.commands.push_back({first_index + command.IdxOffset, command.ElemCount, command.ClipRect.x,
                                    command.ClipRect.y, command.ClipRect.z, command.ClipRect.w});
        }
    }
}

}  // namespace cathlab
