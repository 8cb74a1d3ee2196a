using System;

namespace Brume
{
    /// <summary>The walls, glass and grilles of a map.</summary>
    public sealed class Level : Handle
    {
        private Level(IntPtr created)
        {
            SetHandle(created);
        }

        /// <summary>A level from solid voxels; the arrays are the members of the same name of VoxelsParams.</summary>
        public static Level FromVoxels(Context context, VoxelsParams settings, byte[] bits, byte[] glassBits = null,
                                       byte[] grilleBits = null)
        {
            using (Pins pins = new Pins())
            {
                int bytes = bits == null ? 0 : bits.Length;
                settings.Bits = pins.Add(bits);
                settings.ByteCount = (UIntPtr)bytes;
                settings.GlassBits = OfSize(pins, glassBits, bytes, "glassBits");
                settings.GrilleBits = OfSize(pins, grilleBits, bytes, "grilleBits");
                IntPtr level;
                Calls.Check(Native.brume_level_create_from_voxels(context, ref settings, out level));
                return new Level(level);
            }
        }

        /// <summary>A level from the triangles of a collision mesh, with a Role for each triangle or null: all are
        /// walls.</summary>
        public static Level FromTriangles(Context context, TrianglesParams settings, Point[] points, uint[] indices,
                                          byte[] roles = null)
        {
            using (Pins pins = new Pins())
            {
                settings.Points = pins.Add(points);
                settings.PointCount = (UIntPtr)(points == null ? 0 : points.Length);
                settings.Indices = pins.Add(indices);
                settings.IndexCount = (UIntPtr)(indices == null ? 0 : indices.Length);
                settings.Roles = OfSize(pins, roles, (indices == null ? 0 : indices.Length) / 3, "roles");
                IntPtr level;
                Calls.Check(Native.brume_level_create_from_triangles(context, ref settings, out level));
                return new Level(level);
            }
        }

        private static IntPtr OfSize(Pins pins, byte[] bytes, int count, string name)
        {
            if (bytes != null) Calls.Count(bytes, count, name);
            return pins.Add(bytes);
        }

        public Layout Layout
        {
            get
            {
                Layout layout;
                Calls.Check(Native.brume_level_layout(this, out layout));
                return layout;
            }
        }

        /// <summary>Levels of one hash give the same smoke and lines of sight on every machine.</summary>
        public ulong Hash
        {
            get
            {
                ulong hash;
                Calls.Check(Native.brume_level_hash(this, out hash));
                return hash;
            }
        }

        /// <summary>1 for each voxel of the box [low, high) that is a wall or glass; x fastest, then y, z.</summary>
        public void Solid(Voxel low, Voxel high, byte[] solid)
        {
            UIntPtr count = Calls.Volume(low, high, solid, "solid");
            Calls.Check(Native.brume_level_solid(this, low, high, solid, count));
        }

        /// <summary>The Role of each voxel of the box, in the same order.</summary>
        public void Roles(Voxel low, Voxel high, byte[] roles)
        {
            UIntPtr count = Calls.Volume(low, high, roles, "roles");
            Calls.Check(Native.brume_level_roles(this, low, high, roles, count));
        }

        protected override bool ReleaseHandle()
        {
            return Native.brume_level_destroy(handle) == Result.Ok;
        }
    }

    /// <summary>An image that shots may cut out of smoke: rows from the top, 255 removes all smoke.</summary>
    public struct Mask
    {
        public uint Width, Height;
        public byte[] Texels;
    }

    /// <summary>A set of masks. Sender and receiver need the same set.</summary>
    public sealed class Masks : Handle
    {
        public Masks(Context context, Mask[] images)
        {
            using (Pins pins = new Pins())
            {
                MaskImage[] pinned = new MaskImage[images.Length];
                for (int i = 0; i < images.Length; ++i)
                {
                    Mask image = images[i];
                    if (image.Texels == null || (ulong)image.Texels.Length < (ulong)image.Width * image.Height)
                        throw new ArgumentException("image " + i + " has fewer texels than width * height", "images");
                    pinned[i] = new MaskImage { Width = image.Width, Height = image.Height,
                                                Texels = pins.Add(image.Texels) };
                }
                IntPtr created;
                Calls.Check(Native.brume_masks_create(context, pinned, (UIntPtr)pinned.Length, out created));
                SetHandle(created);
            }
        }

        protected override bool ReleaseHandle()
        {
            return Native.brume_masks_destroy(handle) == Result.Ok;
        }
    }
}
