"""The code around excerpts on pages, by their language and by the name in their fence. BLOCK stands for the excerpt,
and INCLUDES, where it is there, for the lines of the excerpt that include."""

SEE_THE_TREE = {"containers", "suite"}  # of C++, these include more than what is installed

# The page on sets shows these, and its later blocks take them for given, for C++ and GLSL alike: the sample's
# materials, a queue and arguments of a kernel.
MATERIALS = """#include "twinray/glsl/soa.h"
#include "samples/materials.h"
#define RAY_QUEUE(X, P) X(P, 0, vec3, origin) X(P, 1, vec3, direction) X(P, 2, uint, pixel)
TWINRAY_SOA_VIEW(RayQueue, RAY_QUEUE)
struct PaintArgs { MaterialSet materials; TextureTable textures; };
"""


def including(headers, quotes):
    return "".join(f"#include {quotes[0]}{header}{quotes[1]}\n" for header in headers.split())


def function(headers, parameters, above=""):
    """Lines of a page in a function of a host, with names that they use."""
    head = including(headers, "<>") + above + "using namespace twinray;\n"
    return f"{head}void lines_of_a_page({parameters}) {{\n{{ BLOCK }}\n}}\n"


def kernel(headers, push="", main="", above="", block="", includes=""):
    """Lines of a page in the main function of a kernel, or, as `block`, beside it."""
    constants = f"layout(push_constant, scalar) uniform Push {{ {push} }} push;\n" if push else ""
    head = "#version 460\n#extension GL_GOOGLE_include_directive : require\n" + includes + including(headers, '""')
    return f"{head}{above}layout(local_size_x = 64) in;\n{constants}{block}void main()\n{{\n{main}\n}}\n"


HOST = """VkInstance instance, VkPhysicalDevice physical_device, VkDevice device, VkDeviceCreateInfo device_create_info,
    PFN_vkGetInstanceProcAddr get_instance_proc_addr, std::mutex& mutex"""
ACCEL = "Context& context, AbstractAccel& accel"
RAYS = "const std::vector<Ray>& rays"
TRACED = "Address accel; REF(Ray) rays; REF(Hit) hits;"
CPP = {
    "animation": function(
        "twinray/scene.h twinray/twinray.h",
        f"""{ACCEL}, Commands& commands, AccelHandle handle, Scene& scene, Pose& pose, std::size_t i, double t,
        std::size_t k, Floats positions, std::size_t count""",
    ),
    "containers": function(
        "span vector twinray/scene.h twinray/sets.h",
        """Context& context, Commands& commands, TWINRAY_MULTI_TYPE_SET(MaterialSet, MATERIALS) & materials,
        TextureStore& textures, TextureRef texture, const Image& image, const std::vector<float>& values,
        const Kernel<PaintArgs>& kernel, uint count""",
        "namespace twinray {\n"
        + including("twinray/glsl/cpp_begin.h", '""')
        + MATERIALS
        + including("twinray/glsl/cpp_end.h", '""')
        + "}\n",
    ),
    "embedding": function(
        "mutex string twinray/twinray.h vk_mem_alloc.h twinray/vma_adapter.h",
        f"""{HOST}, {ACCEL}, VmaAllocator your_vma_allocator, VkCommandBuffer command_buffer, VkSemaphore your_timeline,
        uint64_t value, Ref<Ray> rays, Ref<Hit> hits, uint64_t count""",
        "void log(const std::string& sentence);\n",
    ),
    "function": function(
        "cmath mutex vector twinray/analysis.h twinray/queries.h twinray/scene.h twinray/twinray.h",
        f"{ACCEL}, const Mesh& mesh, {RAYS}, Ray ray",
    ),
    "host": function(
        "mutex twinray/twinray.h", f"{HOST}, VkQueue queue, uint32_t queue_family, VkPipelineCache pipeline_cache"
    ),
    "kernels": "INCLUDES\n"
    + function(
        "array span vector twinray/twinray.h",
        f"""{ACCEL}, Commands& commands, const Mesh& mesh, const Mesh& leaf_mesh, const Transform& transform,
        const std::vector<Bounds>& boxes, {RAYS}, const std::vector<Hit>& hits, const std::vector<float>& temperatures,
        MeshInfo info, const Buffer& ray_buffer, const Buffer& hit_buffer, const Buffer& sphere_buffer,
        const Buffer& vertices, const Buffer& indices, const Buffer& counter, uint count, std::size_t n,
        std::size_t most, TraceDesc desc, const Kernel<WaterArgs>& make_water, WaterArgs args, uint cells""",
        "struct MeshInfo { float density; };\nstruct WaterArgs { twinray::Address positions; };\n",
    ),
    "queries": function(
        "vector twinray/queries.h twinray/twinray.h",
        f"""{ACCEL}, const Scene& scene, AbstractAccel& accel_a, AbstractAccel& accel_b, AccelHandle handle_a,
        AccelHandle handle_b, const std::vector<TrianglePair>& pairs, const std::vector<dvec3>& points,
        double max_distance, double radius""",
    ),
    "reference": "INCLUDES\n"
    + function("vector twinray/twinray.h", f"AbstractAccel& accel, const Scene& scene, {RAYS}"),
    "suite": including("validation/reference/aimed_rays.h report/suite/case_run.h", '""')
    + "namespace twinray::suite {\nBLOCK\n}\n",
}
GLSL = {
    "containers": kernel(
        "twinray/glsl/soa.glsl twinray/glsl/textures.glsl",
        "TextureTable textures; TextureRef heat; RayQueue queue, next;",
        """uint i = global_index(), pixel = i;
        vec2 uv = vec2(0.5);
        Painted painted = Painted(push.heat, 1.0);
        BLOCK""",
        MATERIALS,
    ),
    "header": kernel("twinray/glsl/common.glsl", block="BLOCK\n"),  # a header that a kernel includes, and C++ as well
    "kernel": "#version 460\n#extension GL_GOOGLE_include_directive : require\nlayout(local_size_x = 64) in;\nBLOCK\n",
    "materials": kernel(
        "twinray/glsl/multi_type_set.glsl twinray/glsl/textures.glsl",
        "MaterialSet materials; TextureTable textures; REF(SetKey) keys;",
        above=MATERIALS,
        block="BLOCK\n",
    ),
    "next_hit": kernel(
        "",
        "Address accel; REF(Ray) rays; Floats depths; float density;",
        """Address accel = push.accel;
        Ray ray = AT(push.rays, global_index());
        float depth = 0.0, density = push.density;
        BLOCK
        AT(push.depths, global_index()) = depth;""",
        includes="INCLUDES\n",
    ),
    "spawn": kernel(
        "twinray/glsl/query.glsl",
        "Address accel; REF(Ray) rays; REF(InstanceRecord) instances; Floats positions; Uints indices; Uints blocked;",
        """uint index_in_handle = 0u;
        vec3 to_light = vec3(0.0, 1.0, 0.0);
        Hit hit;
        if (!closest_hit(push.accel, AT(push.rays, global_index()), hit)) return;
        BLOCK
        AT(push.blocked, global_index()) = any_hit(push.accel, shadow) ? 1u : 0u;""",
        "INCLUDES\n",
    ),
    "surface": kernel(
        "twinray/glsl/surface.glsl",
        f"{TRACED} uint heat;",
        """Address accel = push.accel;
        Ray ray = AT(push.rays, global_index());
        Hit hit = AT(push.hits, global_index());
        BLOCK""",
        "struct MeshInfo { float density; };\nBUFFER_OF(MeshInfo, 4);\n",
        includes="INCLUDES\n",
    ),
    "trace_program": kernel(
        "twinray/glsl/common.glsl",
        TRACED,
        """Hit hit;
        closest_hit(push.accel, AT(push.rays, global_index()), hit);
        AT(push.hits, global_index()) = hit;""",
        "BLOCK\n" + including("twinray/glsl/query.glsl", '""'),  # the traversals call it like this
        includes="#define TWINRAY_PROGRAM\n",
    ),
}
WRAPS = {"cpp": CPP, "glsl": GLSL}
