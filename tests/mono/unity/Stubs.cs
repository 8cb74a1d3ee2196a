// What SmokeView.cs of integrations/unity calls of Unity, as its manual declares it: enough to compile and to run it.
using System;
using System.Collections.Generic;

namespace UnityEngine.Experimental.Rendering
{
    public enum GraphicsFormat
    {
        None, R8_UNorm, R8G8_UNorm, R8G8B8A8_UNorm, R16G16B16A16_SFloat, R32G32B32A32_SFloat, R16_UInt, R32_UInt,
        R32G32_UInt, R32G32B32A32_UInt
    }

    [Flags]
    public enum TextureCreationFlags { None = 0, MipChain = 1 }
}

namespace UnityEngine
{
    using UnityEngine.Experimental.Rendering;

    public class Object
    {
        public static void Destroy(Object gone) { }
    }

    public struct Vector3
    {
        public float x, y, z;
        public static Vector3 operator -(Vector3 a) { return new Vector3 { x = -a.x, y = -a.y, z = -a.z }; }
    }

    public struct Vector4
    {
        public float x, y, z, w;
        public Vector4(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
    }

    public struct Color
    {
        public float r, g, b, a;
        public Color linear { get { return this; } }
        public static Color operator *(Color c, float f)
        {
            return new Color { r = c.r * f, g = c.g * f, b = c.b * f, a = c.a * f };
        }
    }

    public class Transform : Object
    {
        public Vector3 position { get; set; }
        public Vector3 forward { get; set; }
    }

    public class MonoBehaviour : Object { }

    public enum LightType { Spot, Directional, Point }

    public sealed class Light : Object
    {
        private readonly Transform place = new Transform();
        public Transform transform { get { return place; } }
        public LightType type { get; set; }
        public Color color { get; set; }
        public float intensity { get; set; }
    }

    public class Texture : Object
    {
        public int mipmapCount { get { return 1; } }
    }

    public sealed class Texture2D : Texture
    {
        public Texture2D(int width, int height, GraphicsFormat format, TextureCreationFlags flags) { }
        public void SetPixelData<T>(T[] data, int mipLevel) { }
        public void Apply(bool updateMipmaps, bool makeNoLongerReadable) { }
    }

    public sealed class Texture3D : Texture
    {
        public Texture3D(int width, int height, int depth, GraphicsFormat format, TextureCreationFlags flags) { }
        public void SetPixelData<T>(T[] data, int mipLevel) { }
        public void Apply(bool updateMipmaps) { }
        public void Apply(bool updateMipmaps, bool makeNoLongerReadable) { }
    }

    public sealed class Shader : Object
    {
        /// <summary>What is set, for tests.</summary>
        public static readonly Dictionary<string, object> Globals = new Dictionary<string, object>();
        public static void SetGlobalTexture(string name, Texture value) { Globals[name] = value; }
        public static void SetGlobalVector(string name, Vector4 value) { Globals[name] = value; }
        public static void SetGlobalVectorArray(string name, Vector4[] values) { Globals[name] = values; }
    }
}
