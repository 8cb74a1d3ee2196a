using System;
using System.Runtime.InteropServices;

namespace Brume
{
    /// <summary>The smoke of a field as textures for a shader, with what changed from update to update.</summary>
    public sealed class Textures : Handle
    {
        private readonly int lightCount;
        private uint updates;

        public Textures(Field field) : this(field, Defaults.Textures(), Defaults.Drawn())
        {
        }

        /// <param name="look">The noise that erodes the smoke.</param>
        public Textures(Field field, TexturesParams settings, DrawnParams look)
        {
            lightCount = (int)settings.LightCount;
            using (Pins pins = new Pins())
            {
                settings.Look = pins.Add(new[] { look });
                IntPtr created;
                Calls.Check(Native.brume_textures_create(field, ref settings, out created));
                SetHandle(created);
            }
        }

        /// <param name="seconds">The time of the field's state, or later, between two ticks.</param>
        /// <param name="lights">TexturesParams.LightCount of them.</param>
        /// <param name="lightUpdateFraction">Fraction of the light that this update finds; 0: all.</param>
        public void Update(Field field, double seconds, TextureLight[] lights = null, float lightUpdateFraction = 0)
        {
            Calls.Count(lights, lightCount, "lights");
            ++updates;
            using (Pins pins = new Pins())
            {
                TexturesFrame frame = Defaults.Frame();
                frame.Seconds = seconds;
                frame.Lights = pins.Add(lights);
                frame.LightUpdateFraction = lightUpdateFraction;
                Calls.Check(Native.brume_textures_update(this, field, ref frame));
            }
        }

        /// <summary>The textures that the shader reads, by their TextureKind. One whose generation has risen has to be
        /// made again.</summary>
        public void List(SmokeTexture[] list)
        {
            Calls.Count(list, (int)TextureKind.Count, "list");
            Calls.Check(Native.brume_textures_list(this, list, (UIntPtr)(uint)list.Length));
        }

        /// <summary>What the last update changed, as lists of a State are written. Texels are valid until the next
        /// update: Copy refuses older ones, by the number of their update in Reserved.</summary>
        public int Regions(ref Region[] regions)
        {
            IntPtr first;
            UIntPtr count;
            Calls.Check(Native.brume_textures_regions(this, out first, out count));
            if (regions == null || (ulong)regions.Length < (ulong)count) regions = new Region[(ulong)count];
            int size = Marshal.SizeOf(typeof(Region));
            for (int i = 0; i < (int)(uint)count; ++i)
            {
                IntPtr region = new IntPtr(first.ToInt64() + (long)i * size);
                regions[i] = (Region)Marshal.PtrToStructure(region, typeof(Region));
                regions[i].Reserved = updates;
            }
            return (int)(uint)count;
        }

        /// <summary>The vectors of four that the shader reads as brume_constants.</summary>
        public void Constants(float[] constants)
        {
            UIntPtr count = Calls.Count(constants, (int)Limits.Constants, "constants");
            Calls.Check(Native.brume_textures_constants(this, constants, count));
        }

        /// <summary>Copies a region of the last update into the bytes of its whole texture, x fastest, then y, then z:
        /// for engines that upload whole textures.</summary>
        public void Copy(Region region, SmokeTexture texture, byte[] texels)
        {
            using (new Borrowed(this)) CopyRows(region, texture, texels);
        }

        private void CopyRows(Region region, SmokeTexture texture, byte[] texels)
        {
            if (region.Reserved != updates || region.Texels == IntPtr.Zero)
                throw new InvalidOperationException("the region is of an earlier update, its texels are gone");
            int texel = BytesOf((SmokeTextureFormat)texture.Format);
            long bytes = (long)texel * texture.Width * texture.Height * texture.Depth;
            if (texels == null || texels.Length < bytes)
                throw new ArgumentException(bytes + " bytes are expected", "texels");
            int row = texel * (int)region.Width;
            long source = region.Texels.ToInt64();
            for (uint z = region.Z; z < region.Z + region.Depth; ++z)
                for (uint y = region.Y; y < region.Y + region.Height; ++y, source += row)
                {
                    long first = ((long)z * texture.Height + y) * texture.Width + region.X;
                    Marshal.Copy(new IntPtr(source), texels, (int)(first * texel), row);
                }
        }

        /// <summary>The size of a texel.</summary>
        public static int BytesOf(SmokeTextureFormat format)
        {
            switch (format)
            {
                case SmokeTextureFormat.R8: return 1;
                case SmokeTextureFormat.Rg8:
                case SmokeTextureFormat.R16ui: return 2;
                case SmokeTextureFormat.Rgba8:
                case SmokeTextureFormat.R32ui: return 4;
                case SmokeTextureFormat.Rgba16f:
                case SmokeTextureFormat.Rg32ui: return 8;
                case SmokeTextureFormat.Rgba32f:
                case SmokeTextureFormat.Rgba32ui: return 16;
                default: return 0;
            }
        }

        protected override bool ReleaseHandle()
        {
            return Native.brume_textures_destroy(handle) == Result.Ok;
        }
    }
}
