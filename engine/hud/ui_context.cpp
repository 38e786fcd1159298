#include "hud/ui_context.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/check.h"

namespace cathlab {
namespace {

static_assert(static_cast<int>(UiKey::count) == ImGuiKey_COUNT, "UiKey lists ImGui's keys in its order");

void feed(ImGuiIO& io, const UiInput& input) {
    const bool off = input.mouse_x < 0.0F || input.mouse_y < 0.0F;
    io.MousePos = off ? ImVec2(-FLT_MAX, -FLT_MAX) : ImVec2(input.mouse_x, input.mouse_y);
    for (std::size_t i = 0; i < input.mouse.size(); ++i) io.MouseDown[i] = input.mouse[i];
    io.MouseWheel = input.wheel;
    for (std::size_t i = 0; i < input.keys.size(); ++i) io.KeysDown[i] = input.keys[i];
    io.KeyShift = input.shift;
    io.KeyCtrl = input.control;
    constexpr std::array<ImGuiNavInput, static_cast<std::size_t>(UiNav::count)> nav{
        ImGuiNavInput_Activate, ImGuiNavInput_Cancel,   ImGuiNavInput_DpadLeft,  ImGuiNavInput_DpadRight,
        ImGuiNavInput_DpadUp,   ImGuiNavInput_DpadDown, ImGuiNavInput_FocusPrev, ImGuiNavInput_FocusNext};
    for (std::size_t i = 0; i < nav.size(); ++i) io.NavInputs[nav[i]] = input.nav[i];
    if (!input.text.empty()) io.AddInputCharactersUTF8(input.text.c_str());
}

}  // namespace

struct UiContext::Impl {
    float font_px = 16;
    ImGuiContext* context = nullptr;
    std::shared_ptr<const DrawAtlas> atlas;

    const ImGuiIO& io() const {
        ImGui::SetCurrentContext(context);
        return ImGui::GetIO();
    }
};

UiContext::UiContext(float font_px, bool steered, const std::string& font_file) : impl_(std::make_unique<Impl>()) {
    CATHLAB_CHECK(font_px >= 8.0F && font_px <= 96.0F, "height of a font out of [8, 96]");
    impl_->font_px = std::round(font_px);
    impl_->context = ImGui::CreateContext();
    ImGui::SetCurrentContext(impl_->context);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset | ImGuiBackendFlags_HasGamepad;
    if (steered) io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard | ImGuiConfigFlags_NavEnableGamepad;
    for (int i = 0; i < static_cast<int>(UiKey::count); ++i) io.KeyMap[i] = i;

    const std::string file = font_file.empty() ? "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf" : font_file;
    ImFont* font = nullptr;
    if (std::filesystem::is_regular_file(file)) {
        ImFontConfig config;
        config.OversampleH = 3;
        config.OversampleV = 2;
        font = io.Fonts->AddFontFromFileTTF(file.c_str(), impl_->font_px, &config);
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

UiContext::~UiContext() {
    ImGui::DestroyContext(impl_->context);
}

void UiContext::begin(float width, float height, float dt, const UiInput& input) {
    ImGui::SetCurrentContext(impl_->context);
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(width, height);
    io.DeltaTime = std::max(1e-4F, dt);
    feed(io, input);
    // ImGui lets the first key or button only show where it stands; here it counts at once.
    const auto used = [](const auto& list) {
        return std::any_of(list.begin(), list.end(), [](auto v) { return v != 0; });
    };
    if ((io.ConfigFlags & ImGuiConfigFlags_NavEnableGamepad) != 0 && (used(input.nav) || used(input.keys)))
        ImGui::GetCurrentContext()->NavDisableHighlight = false;
    ImGui::NewFrame();
}

void UiContext::end(HudDrawList& out) {
    ImGui::Render();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    out.width = size.x;
    out.height = size.y;
    out.atlas = impl_->atlas;
    out.vertices.clear();
    out.indices.clear();
    out.commands.clear();
    const ImDrawData* drawn = ImGui::GetDrawData();
    for (int i = 0; i < drawn->CmdListsCount; ++i) {
        const ImDrawList* list = drawn->CmdLists[i];
        const auto first_vertex = static_cast<std::uint32_t>(out.vertices.size());
        const auto first_index = static_cast<std::uint32_t>(out.indices.size());
        for (const ImDrawVert& v : list->VtxBuffer) out.vertices.push_back({v.pos.x, v.pos.y, v.uv.x, v.uv.y, v.col});
        for (const ImDrawIdx index : list->IdxBuffer) out.indices.push_back(first_vertex + index);
        for (const ImDrawCmd& command : list->CmdBuffer) {
            if (command.ElemCount == 0 || command.UserCallback != nullptr) continue;
            // A list of more vertices than an index can name goes on from an offset.
            const auto begin = first_index + command.IdxOffset;
            for (std::uint32_t k = 0; command.VtxOffset > 0 && k < command.ElemCount; ++k)
                out.indices[begin + k] += command.VtxOffset;
            out.commands.push_back({begin, command.ElemCount, command.ClipRect.x, command.ClipRect.y,
                                    command.ClipRect.z, command.ClipRect.w});
        }
    }
}

float UiContext::font_px() const {
    return impl_->font_px;
}

bool UiContext::wants_text() const {
    return impl_->io().WantTextInput;
}

bool UiContext::wants_mouse() const {
    return impl_->io().WantCaptureMouse;
}

}  // namespace cathlab
