using System;
using Brume;
using UnityEngine;
using UnityEngine.Experimental.Rendering;

/// <summary>Gives the smoke of a field to BrumeSmoke.hlsl: textures, constants and lights, as globals of all shaders.
/// Copy it into your project, and call Follow once and Show each frame.</summary>
public sealed class SmokeView : MonoBehaviour
{
    private static readonly string[] Names = { "brume_density", "brume_displacement", "brume_pages", "brume_cells",
        "brume_boundary", "brume_corners", "brume_holes", "brume_masks", "brume_noise", "brume_detail",
        "brume_light_volume" };
    private static readonly GraphicsFormat[] Formats = { GraphicsFormat.None, GraphicsFormat.R8_UNorm,
        GraphicsFormat.R8G8_UNorm, GraphicsFormat.R8G8B8A8_UNorm, GraphicsFormat.R16G16B16A16_SFloat,
        GraphicsFormat.R32G32B32A32_SFloat, GraphicsFormat.R16_UInt, GraphicsFormat.R32_UInt,
        GraphicsFormat.R32G32_UInt, GraphicsFormat.R32G32B32A32_UInt };

    /// <summary>Point and directional lights that the smoke scatters; as many as there were at Follow.</summary>
    public Light[] Lights = new Light[0];
    /// <summary>Radiance of the sky, and what walls and ground reflect of it.</summary>
    public Vector4 Ambient = new Vector4(0.25f, 0.29f, 0.35f, 0.2f);
    /// <summary>Of the light, how much each frame finds.</summary>
    public float LightFraction = 0.125f;

    private readonly SmokeTexture[] list = new SmokeTexture[(int)TextureKind.Count];
    private readonly uint[] made = new uint[(int)TextureKind.Count];
    private readonly Texture[] textures = new Texture[(int)TextureKind.Count];
    private readonly byte[][] texels = new byte[(int)TextureKind.Count][];
    private readonly bool[] changed = new bool[(int)TextureKind.Count];
    private readonly float[] constants = new float[Limits.Constants];
    private readonly Vector4[] rows = new Vector4[Limits.Constants / 4];
    private readonly Vector4[] positions = new Vector4[Limits.MaxTextureLights];
    private readonly Vector4[] colors = new Vector4[Limits.MaxTextureLights];
    private TextureLight[] lights;
    private Region[] regions;
    private Textures smoke;

    public void Follow(Field field)
    {
        TexturesParams settings = Defaults.Textures();
        settings.LightCount = (uint)Lights.Length;
        settings.Sky = 1;
        smoke = new Textures(field, settings, Defaults.Drawn());
        lights = new TextureLight[Lights.Length];
        Array.Clear(made, 0, made.Length);
    }

    /// <param name="seconds">Of the match: the tick divided by 64, and what has passed since.</param>
    public void Show(Field field, double seconds)
    {
        PlaceLights();
        smoke.Update(field, seconds, lights, LightFraction);
        smoke.List(list);
        for (int i = 0; i < list.Length; ++i)
            if (list[i].Generation != made[i]) Make(i);
        int count = smoke.Regions(ref regions);
        for (int i = 0; i < count; ++i)
        {
            int kind = (int)regions[i].Texture;
            smoke.Copy(regions[i], list[kind], texels[kind]);
            changed[kind] = true;
        }
        for (int i = 0; i < list.Length; ++i)
            if (changed[i]) Upload(i);
        smoke.Constants(constants);
        for (int i = 0; i < rows.Length; ++i)
            rows[i] = new Vector4(constants[4 * i], constants[4 * i + 1], constants[4 * i + 2], constants[4 * i + 3]);
        Shader.SetGlobalVectorArray("brume_constants", rows);
    }

    // The level's z points the other way.
    private void PlaceLights()
    {
        for (int i = 0; i < lights.Length; ++i)
        {
            bool sun = Lights[i].type == LightType.Directional;
            Vector3 at = sun ? -Lights[i].transform.forward : Lights[i].transform.position;
            lights[i].Directional = sun ? 1u : 0u;
            lights[i].At = new Point { X = at.x, Y = at.y, Z = -at.z };
            positions[i] = new Vector4(at.x, at.y, -at.z, sun ? 0 : 1);
            Color color = Lights[i].color.linear * Lights[i].intensity;
            colors[i] = new Vector4(color.r, color.g, color.b, 0);
        }
        Shader.SetGlobalVectorArray("brume_light_positions", positions);
        Shader.SetGlobalVectorArray("brume_light_colors", colors);
        Shader.SetGlobalVector("brume_ambient", Ambient);
    }

    private void Make(int kind)
    {
        SmokeTexture of = list[kind];
        if (textures[kind] != null) Destroy(textures[kind]);
        bool mips = kind == (int)TextureKind.Noise || kind == (int)TextureKind.Detail;
        TextureCreationFlags flags = mips ? TextureCreationFlags.MipChain : TextureCreationFlags.None;
        GraphicsFormat format = Formats[of.Format];
        bool flat = kind >= (int)TextureKind.Boundary && kind <= (int)TextureKind.Masks;
        if (flat) textures[kind] = new Texture2D((int)of.Width, (int)of.Height, format, flags);
        else textures[kind] = new Texture3D((int)of.Width, (int)of.Height, (int)of.Depth, format, flags);
        texels[kind] = new byte[of.Width * of.Height * of.Depth * Textures.BytesOf((SmokeTextureFormat)of.Format)];
        made[kind] = of.Generation;
        Shader.SetGlobalTexture(Names[kind], textures[kind]);
    }

    private void Upload(int kind)
    {
        changed[kind] = false;
        Texture2D flat = textures[kind] as Texture2D;
        Texture3D deep = textures[kind] as Texture3D;
        if (flat != null) flat.SetPixelData(texels[kind], 0);
        if (flat != null) flat.Apply(false, false);
        if (deep != null) deep.SetPixelData(texels[kind], 0);
        if (deep != null) deep.Apply(deep.mipmapCount > 1, false);
    }

    private void OnDestroy()
    {
        if (smoke != null) smoke.Dispose();
        foreach (Texture texture in textures)
            if (texture != null) Destroy(texture);
    }
}
