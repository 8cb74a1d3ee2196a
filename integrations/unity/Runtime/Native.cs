// Written by script/export-csharp from the headers in include/brume: do not edit.
using System;
using System.Runtime.InteropServices;

namespace Brume
{
    public enum Result
    {
        Ok = 0,
        /// <summary>An argument is null, not finite, out of range, or a struct of another size.</summary>
        ErrorArgument = 1,
        /// <summary>A handle is null, of another kind, or not a handle.</summary>
        ErrorHandle = 2,
        /// <summary>Received bytes are damaged, truncated, foreign or of another version.</summary>
        ErrorData = 3,
        /// <summary>A tick is earlier than the history that the world retains.</summary>
        ErrorHistory = 4,
        /// <summary>Two objects differ in level, ticks per second or masks.</summary>
        ErrorMismatch = 5,
        /// <summary>Another call must come first: the message names it.</summary>
        ErrorOrder = 6,
        /// <summary>The capacity of an output is too small.</summary>
        ErrorBuffer = 7,
        /// <summary>The call exceeds a limit of the library.</summary>
        ErrorLimit = 8,
        /// <summary>Memory or threads are exhausted.</summary>
        ErrorMemory = 9,
        /// <summary>An earlier call ran out of memory or over a limit halfway. Until brume_world_restore (for a
        /// world), brume_field_update (for a field) or brume_receiver_reset (for a receiver) succeeds, only
        /// *_destroy works. A broken sender can only be destroyed.</summary>
        ErrorBroken = 10,
        /// <summary>The library has a defect.</summary>
        ErrorInternal = 11,
        /// <summary>The Vulkan device lacks a required feature, or is lost (brume_vulkan.h).</summary>
        ErrorDevice = 12,
    }

    /// <summary>The obstacle that a surface is. Each role stops less than the previous one.</summary>
    public enum Role
    {
        /// <summary>Stops smoke, sight, shots, bodies and thrown grenades.</summary>
        Wall = 0,
        /// <summary>Stops smoke, shots, bodies and thrown grenades, but not sight.</summary>
        Glass = 1,
        /// <summary>Stops bodies and thrown grenades: a fence, leaves.</summary>
        Grille = 2,
        /// <summary>Stops nothing.</summary>
        Ghost = 3,
    }

    public enum EventKind
    {
        Smoke = 1,
        Shot = 2,
        Blast = 3,
        Move = 4,
        Edit = 5,
    }

    public enum HoleShape
    {
        Cylinder = 0,
        Box = 1,
        Mask = 2,
    }

    public enum Reception
    {
        /// <summary>The receiver now has the packet's state, or one of a packet held before.</summary>
        Applied = 0,
        /// <summary>Ignored: the receiver has this state or a later one, or holds its packet.</summary>
        Old = 1,
        /// <summary>The state on which the packet builds is missing. Send a request.</summary>
        Missed = 2,
        /// <summary>The packet is early, and used as soon as those before it have arrived.</summary>
        Held = 3,
    }

    /// <summary>What each texture holds: its place in the list of brume_textures_list, and its name in the
    /// shader. Textures are sampled with linear filtering where that is said, else read texel by texel; edges are
    /// clamped except where they repeat.</summary>
    public enum TextureKind
    {
        /// <summary>brume_density: RG8, 3D, linear.</summary>
        Density = 0,
        /// <summary>brume_displacement: RGBA16F, 3D, linear.</summary>
        Displacement = 1,
        /// <summary>brume_pages: R16UI, 3D.</summary>
        Pages = 2,
        /// <summary>brume_cells: R32UI, 3D.</summary>
        Cells = 3,
        /// <summary>brume_boundary: RGBA32UI, 2D.</summary>
        Boundary = 4,
        /// <summary>brume_corners: RG32UI, 2D.</summary>
        Corners = 5,
        /// <summary>brume_holes: RGBA32F, 2D.</summary>
        Holes = 6,
        /// <summary>brume_masks: R8, 2D, linear.</summary>
        Masks = 7,
        /// <summary>brume_noise: RGBA8, 3D, linear, repeats. Make its mip levels.</summary>
        Noise = 8,
        /// <summary>brume_detail: RG8, 3D, linear, repeats. Make its mip levels.</summary>
        Detail = 9,
        /// <summary>brume_light_volume: RGBA8, 3D, linear. Only with lights or the sky.</summary>
        Light = 10,
        Count = 11,
    }

    /// <summary>Channels, their bits and their type, as graphics interfaces name them. Texels are
    /// little-endian.</summary>
    public enum SmokeTextureFormat
    {
        /// <summary>The texture does not exist yet: its size is 0.</summary>
        None = 0,
        /// <summary>Numbers in [0, 1], like RG8 and RGBA8.</summary>
        R8 = 1,
        Rg8 = 2,
        Rgba8 = 3,
        /// <summary>Half floats.</summary>
        Rgba16f = 4,
        Rgba32f = 5,
        /// <summary>Unsigned integers, as those that follow.</summary>
        R16ui = 6,
        R32ui = 7,
        Rg32ui = 8,
        Rgba32ui = 9,
    }

    /// <summary>Receives the line of each failed call with a handle of its context, as brume_last_error() returns
    /// it, and warnings with BRUME_OK, for example when a volume is shown at a lower resolution. It is called in
    /// the thread of the failed call, after the call's work, possibly by several threads at once; it may then
    /// call any function except the destruction of the handle in use. Threads that load volumes report warnings,
    /// too; from such a thread it must call no function. `line` is valid during the callback, which must not
    /// throw.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public delegate void LogCallback(IntPtr user, Result result, IntPtr line);

    /// <summary>Runs the loops of a call in threads of yours: it calls job(job_data) `count` times, which is at
    /// most thread_count, in any threads and at best at once, and returns when all of these calls have returned.
    /// Fewer calls are right, too: what no job does, the call does. A job neither waits for others nor calls a
    /// callback. It is called within functions that may take many threads, by several threads at once where you
    /// call several at once, and by threads that load volumes. It must not call Brume or throw.</summary>
    [UnmanagedFunctionPointer(CallingConvention.Cdecl)]
    public delegate void RunJobsCallback(IntPtr user, IntPtr job, IntPtr jobData, uint count);

    /// <summary>The settings of a new context.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct ContextParams
    {
        public uint StructSize;
        public IntPtr Next;
        /// <summary>Threads of one call, the caller's included: [1, 1024]; 0: one per core.</summary>
        public uint ThreadCount;
        /// <summary>Null: no callback.</summary>
        public IntPtr Log;
        /// <summary>Passed to `log`.</summary>
        public IntPtr LogUser;
        /// <summary>Null: calls start threads, which end before they return. One thread for each volume file that
        /// changes over time is started in any case.</summary>
        public IntPtr RunJobs;
        /// <summary>Passed to `run_jobs`.</summary>
        public IntPtr JobsUser;
    }

    /// <summary>A voxel, or a size in voxels.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Voxel
    {
        /// <summary>Coordinate, or size along an axis.</summary>
        public int X;
        /// <summary>Coordinate, or size along an axis.</summary>
        public int Y;
        /// <summary>Coordinate, or size along an axis.</summary>
        public int Z;
    }

    /// <summary>A point in the world [m].</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Point
    {
        /// <summary>Coordinate [m].</summary>
        public float X;
        /// <summary>Coordinate [m].</summary>
        public float Y;
        /// <summary>Coordinate [m].</summary>
        public float Z;
    }

    /// <summary>The position and size of a level's voxels. All machines of a match must use the same
    /// bits.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Layout
    {
        /// <summary>Voxels per axis, each in [1, BRUME_MAX_LEVEL_AXIS].</summary>
        public Voxel Size;
        /// <summary>Edge length of a voxel [m], [1/64, 64].</summary>
        public float VoxelSize;
        /// <summary>Low corner of voxel (0, 0, 0) [m], each coordinate within +-16384.</summary>
        public Point Origin;
    }

    /// <summary>A level as solid voxels.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct VoxelsParams
    {
        public uint StructSize;
        public IntPtr Next;
        /// <summary>The position and size of the voxels.</summary>
        public Layout Layout;
        /// <summary>One bit per voxel, 1 = solid, x fastest, then y, then z: voxel (x, y, z) is bit i % 8 of byte
        /// i / 8 with i = x + size.x * (y + size.y * z). Bits after the last voxel are ignored.</summary>
        public IntPtr Bits;
        /// <summary>The size of `bits` in bytes: (size.x * size.y * size.z + 7) / 8.</summary>
        public UIntPtr ByteCount;
        /// <summary>As many bytes, in the same order: the solid voxels that are glass. Null: all are
        /// walls.</summary>
        public IntPtr GlassBits;
        /// <summary>As many bytes, in the same order: the voxels that are grilles, which are not set in `bits`.
        /// Null: none.</summary>
        public IntPtr GrilleBits;
    }

    /// <summary>A level as the triangles of its collision mesh.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct TrianglesParams
    {
        public uint StructSize;
        public IntPtr Next;
        /// <summary>With size (0, 0, 0), the level has the smallest layout around all triangles with `margin`
        /// voxels on every side and an origin that is a multiple of voxel_size; the given origin is then
        /// ignored.</summary>
        public Layout Layout;
        /// <summary>Free voxels on every side, [0, 256].</summary>
        public uint Margin;
        /// <summary>Corners of the triangles [m], finite.</summary>
        public IntPtr Points;
        /// <summary>Number of `points`, at most 2^28.</summary>
        public UIntPtr PointCount;
        /// <summary>Three indices into `points` for each triangle, in any winding. Triangles without area are
        /// allowed.</summary>
        public IntPtr Indices;
        /// <summary>Number of `indices`: a multiple of 3, at most 2^28.</summary>
        public UIntPtr IndexCount;
        /// <summary>The brume_role of each triangle, index_count / 3 bytes. A voxel that several triangles touch
        /// has the role that stops most. Null: all are walls.</summary>
        public IntPtr Roles;
    }

    /// <summary>An image of how much smoke a shot removes.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct MaskImage
    {
        /// <summary>Size in texels, each in [1, 4094].</summary>
        public uint Width;
        /// <summary>Size in texels, each in [1, 4094].</summary>
        public uint Height;
        /// <summary>width * height bytes, rows from the top: 255 removes all smoke, 0 none.</summary>
        public IntPtr Texels;
    }

    /// <summary>A position of an event [1/1024 m], each coordinate within +-BRUME_MAX_COORDINATE.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Position
    {
        /// <summary>Coordinate [1/1024 m].</summary>
        public int X;
        /// <summary>Coordinate [1/1024 m].</summary>
        public int Y;
        /// <summary>Coordinate [1/1024 m].</summary>
        public int Z;
    }

    /// <summary>A smoke grenade is thrown. It flies straight at 20 m/s from `from` through `at` to the first
    /// wall, glass or grille, and detonates in the last free voxel in front of it; without an obstacle it
    /// detonates at `at`. A flight that starts in a solid voxel detonates in the nearest free one, on whichever
    /// side of the wall that lies: let it start at least a voxel in front of the wall that a grenade rests at.
    /// Times are in ticks, because smoke spreads from tick to tick.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct SmokeEvent
    {
        /// <summary>The start of the flight.</summary>
        public Position From;
        /// <summary>A point on its path; equal to `from`, it detonates there.</summary>
        public Position At;
        /// <summary>Amount of smoke, [1, BRUME_MAX_SMOKE_VOXELS]: brume_smoke_voxels(). It reaches as many
        /// voxels, and thins out towards its rim: about three quarters of them show, and their densities add up
        /// to about half.</summary>
        public uint Voxels;
        /// <summary>Time from the detonation to the full amount, [1, BRUME_MAX_TICK].</summary>
        public uint BloomTicks;
        /// <summary>Time from the full amount to the start of the dissolve, [0, BRUME_MAX_TICK].</summary>
        public uint HoldTicks;
        /// <summary>Time from the start of the dissolve to its end, [1, BRUME_MAX_TICK].</summary>
        public uint DissolveTicks;
    }

    /// <summary>A bullet bores a hole into the smoke that is present at this tick. Times are in ms, because a
    /// hole is drawn at any time between two ticks; each is at most 2^30.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct ShotEvent
    {
        /// <summary>The muzzle and a point on the bullet's path; they must differ.</summary>
        public Position Origin;
        /// <summary>The muzzle and a point on the bullet's path; they must differ.</summary>
        public Position Toward;
        /// <summary>Radius of a cylinder, half the edge of a box or mask [1/1024 m], [1, BRUME_MAX_COORDINATE]:
        /// brume_length().</summary>
        public uint Radius1024;
        /// <summary>Time until the hole is open along its whole length.</summary>
        public uint ReachFarMs;
        /// <summary>Time until the hole, once open at a place, has its full radius there.</summary>
        public uint ExpandMs;
        /// <summary>Time for which the hole then stays open.</summary>
        public uint StayOpenMs;
        /// <summary>Time in which the hole then closes.</summary>
        public uint FadeMs;
        /// <summary>A brume_hole_shape.</summary>
        public uint Shape;
        /// <summary>Index into the masks of the world; 0 unless the shape is BRUME_HOLE_MASK.</summary>
        public uint MaskIndex;
        /// <summary>Clockwise rotation as the shooter sees it [1/65536 turn], [0, 65535].</summary>
        public uint Roll65536;
    }

    /// <summary>An explosion drives the smoke out of every voxel that is visible from it. Times are in ms, as for
    /// shots.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct BlastEvent
    {
        /// <summary>The centre of the explosion.</summary>
        public Position At;
        /// <summary>Radius of the cavity [1/1024 m], from 1 to 64 voxels: brume_length().</summary>
        public uint Radius1024;
        /// <summary>Speed of its front [1/1024 m/s], [1024, 2^24]: brume_length().</summary>
        public uint Speed1024;
        /// <summary>Fraction of the density that remains inside [1/255], [0, 255].</summary>
        public uint Remaining255;
        /// <summary>Time until the rim is full again, [1, 2^30].</summary>
        public uint RefillRimMs;
        /// <summary>Time until the middle is full again, [refill_rim_ms, 2^30].</summary>
        public uint RefillMiddleMs;
    }

    /// <summary>A player or object moves. Its first move places it.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct MoveEvent
    {
        /// <summary>The caller's number for the player or object.</summary>
        public uint Body;
        /// <summary>Its new position.</summary>
        public Position To;
    }

    /// <summary>The level changes, because a door opens or a wall breaks: all voxels of the box [low, high)
    /// become walls, or free of all roles. The part of the box outside the level is ignored; the box must contain
    /// a voxel. Smoke ends at the faces of edited voxels.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct EditEvent
    {
        /// <summary>The box [low, high).</summary>
        public Voxel Low;
        /// <summary>The box [low, high).</summary>
        public Voxel High;
        /// <summary>1: the voxels become walls; 0: they become free.</summary>
        public uint Solid;
    }

    /// <summary>An event of a world's log.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct WorldEvent
    {
        /// <summary>sizeof(brume_event), in every version: new kinds fit into `reserved`.</summary>
        public uint StructSize;
        public IntPtr Next;
        /// <summary>A brume_event_kind: it selects the member of `u`.</summary>
        public uint Kind;
        /// <summary>The tick at which the event takes effect, [0, BRUME_MAX_TICK].</summary>
        public uint Tick;
        /// <summary>The contents of the event, by its kind.</summary>
        public WorldEventContents U;
    }

    [StructLayout(LayoutKind.Explicit, Size = 128)]
    public struct WorldEventContents
    {
        [FieldOffset(0)] public SmokeEvent Smoke;
        [FieldOffset(0)] public ShotEvent Shot;
        [FieldOffset(0)] public BlastEvent Blast;
        [FieldOffset(0)] public MoveEvent Move;
        [FieldOffset(0)] public EditEvent Edit;
    }

    /// <summary>The settings of a new world.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct WorldParams
    {
        public uint StructSize;
        public IntPtr Next;
        /// <summary>The tick rate, [1, 1000].</summary>
        public uint TicksPerSecond;
        /// <summary>The masks that shots may use; null: none.</summary>
        public IntPtr Masks;
    }

    /// <summary>Counts and times of a state.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct StateInfo
    {
        /// <summary>The tick of the state.</summary>
        public uint Tick;
        /// <summary>The tick rate of its world.</summary>
        public uint TicksPerSecond;
        /// <summary>Events that have taken effect so far.</summary>
        public uint EventCount;
        /// <summary>Grenades in the air.</summary>
        public uint GrenadeCount;
        /// <summary>Clouds of smoke.</summary>
        public uint CloudCount;
        /// <summary>Cavities of explosions.</summary>
        public uint BlastCount;
        /// <summary>Holes of shots.</summary>
        public uint HoleCount;
        /// <summary>Bodies.</summary>
        public uint BodyCount;
    }

    /// <summary>A box in the world, in metres and closed, unlike boxes of voxels.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Box
    {
        /// <summary>Its corners [m], each coordinate within +-16384, `low` not above `high`.</summary>
        public Point Low;
        /// <summary>Its corners [m], each coordinate within +-16384, `low` not above `high`.</summary>
        public Point High;
    }

    /// <summary>A grenade in the air.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Grenade
    {
        /// <summary>Number of its event. Its cloud will have the same id.</summary>
        public uint Id;
        /// <summary>Start and end of its flight.</summary>
        public uint ThrowTick;
        /// <summary>Start and end of its flight.</summary>
        public uint DetonationTick;
        /// <summary>The voxel in which it detonates.</summary>
        public Voxel Landing;
        /// <summary>Its position at the state's tick [m].</summary>
        public Point Position;
    }

    /// <summary>The smoke of one grenade.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Cloud
    {
        /// <summary>Number of its event.</summary>
        public uint Id;
        /// <summary>Start of the bloom.</summary>
        public uint DetonationTick;
        /// <summary>End of the dissolve: from this tick on the cloud is not listed.</summary>
        public uint EndTick;
        /// <summary>The voxel of the detonation.</summary>
        public Voxel Source;
        /// <summary>A box [low, high) around all voxels that it may fill at any tick.</summary>
        public Voxel Low;
        /// <summary>A box [low, high) around all voxels that it may fill at any tick.</summary>
        public Voxel High;
    }

    /// <summary>The cavity of an explosion.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Blast
    {
        /// <summary>Number of its event.</summary>
        public uint Id;
        /// <summary>The tick of the explosion.</summary>
        public uint Tick;
        /// <summary>The tick from which on the cavity is full again, and not listed.</summary>
        public uint EndTick;
        /// <summary>The centre of the explosion.</summary>
        public Position Centre;
        /// <summary>Its radius [1/1024 m].</summary>
        public uint Radius1024;
    }

    /// <summary>The hole of a shot.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Hole
    {
        /// <summary>Number of its event.</summary>
        public uint Id;
        /// <summary>The tick of the shot.</summary>
        public uint Tick;
        /// <summary>The muzzle and a point on the bullet's path.</summary>
        public Position Origin;
        /// <summary>The muzzle and a point on the bullet's path.</summary>
        public Position Toward;
        /// <summary>Radius, or half the edge [1/1024 m].</summary>
        public uint Radius1024;
        /// <summary>Depth of the hole from the muzzle [1/1024 m].</summary>
        public uint Distance1024;
        /// <summary>A brume_hole_shape.</summary>
        public uint Shape;
        /// <summary>As in brume_shot_event.</summary>
        public uint MaskIndex;
        /// <summary>As in brume_shot_event.</summary>
        public uint Roll65536;
    }

    /// <summary>A body, with its last two positions.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct MovingBody
    {
        /// <summary>The caller's number.</summary>
        public uint Body;
        /// <summary>The ticks of its last move and of the move before.</summary>
        public uint Tick;
        /// <summary>The ticks of its last move and of the move before.</summary>
        public uint PreviousTick;
        /// <summary>Its positions after these moves.</summary>
        public Position Position;
        /// <summary>Its positions after these moves.</summary>
        public Position PreviousPosition;
    }

    /// <summary>The settings of a new sender.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct SenderParams
    {
        public uint StructSize;
        public IntPtr Next;
        /// <summary>Number of past states from which it can answer a receiver with a difference, [1, 65536]. A
        /// receiver that is further behind gets a whole state.</summary>
        public uint History;
    }

    /// <summary>The settings of a new receiver. A packet above a limit is BRUME_ERROR_DATA.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct ReceiverParams
    {
        public uint StructSize;
        public IntPtr Next;
        /// <summary>Bytes of one packet, [1, 2^24].</summary>
        public ulong MaxBytes;
        /// <summary>Voxels of all smoke in one packet, [1, 2^26].</summary>
        public ulong MaxVoxels;
        /// <summary>Elements of each list in a packet, [1, 2^20].</summary>
        public ulong MaxItems;
        /// <summary>The level that the sender's states must be of; it may be destroyed before the receiver. Null:
        /// any.</summary>
        public IntPtr Level;
        /// <summary>By how many ticks your transport lets packets overtake others, [0, 64]. Packets that come up
        /// to so many ticks early are held, so many at most and max_bytes together at most, and used in the order
        /// of their ticks as soon as the earlier ones arrive. The loss of a packet is noticed so many ticks
        /// later. 0: none are held, for a transport that keeps the order. 2 suits most others at 64 ticks per
        /// second.</summary>
        public uint HoldTicks;
    }

    /// <summary>The settings of a new field.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct FieldParams
    {
        public uint StructSize;
        public IntPtr Next;
        /// <summary>Extinction of the densest smoke, without erosion [1/m], [0, 10^6].</summary>
        public float Extinction;
        /// <summary>The masks of the worlds whose states it takes over; null: none.</summary>
        public IntPtr Masks;
    }

    /// <summary>A line from a to b. Coordinates must be finite and within +-16384 m; they may lie outside the
    /// level, where the air is clear.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Segment
    {
        /// <summary>An end [m].</summary>
        public Point A;
        /// <summary>An end [m].</summary>
        public Point B;
    }

    /// <summary>The first voxel of a wall along a segment. Glass and grilles are not walls.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Wall
    {
        /// <summary>1: there is a wall; 0: there is none, and all other members are 0.</summary>
        public uint Hit;
        /// <summary>The voxel.</summary>
        public Voxel Voxel;
        /// <summary>Outward normal of the face through which the segment enters: a unit vector.</summary>
        public Voxel Normal;
        /// <summary>Distance from a to that face [m].</summary>
        public float Distance;
    }

    /// <summary>The noise that erodes drawn smoke; brume_smoke_look of brume_vulkan.h has members of the same
    /// names. Give both the same values, and `detail` = 1 - brume_frame_params::detail_reduction.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct DrawnParams
    {
        public uint StructSize;
        public IntPtr Next;
        /// <summary>Strength of the erosion, [0, 1]; 0: no erosion.</summary>
        public float Erosion;
        /// <summary>Size of the largest billows [m], [0.05, 100].</summary>
        public float NoiseSize;
        /// <summary>Weight of the noise finer than a tenth of noise_size, [0, 1].</summary>
        public float Detail;
        /// <summary>Distance by which noise frays the rims of holes [m], [0, 10].</summary>
        public float HoleRim;
        /// <summary>Distance by which the noise swirls [m], [0, 10].</summary>
        public float Swirl;
        /// <summary>Speed at which the noise rises [m/s], [-10, 10].</summary>
        public float Rise;
    }

    /// <summary>A texture that your renderer makes.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct SmokeTexture
    {
        /// <summary>A brume_texture_format.</summary>
        public uint Format;
        /// <summary>Size in texels; the depth of a 2D texture is 1.</summary>
        public uint Width;
        /// <summary>Size in texels; the depth of a 2D texture is 1.</summary>
        public uint Height;
        /// <summary>Size in texels; the depth of a 2D texture is 1.</summary>
        public uint Depth;
        /// <summary>Rises when the texture has to be made again, empty: the regions of the same update then write
        /// all of it that is read.</summary>
        public uint Generation;
    }

    /// <summary>A box of texels to be uploaded.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct Region
    {
        /// <summary>A brume_texture_kind.</summary>
        public uint Texture;
        /// <summary>Its first texel.</summary>
        public uint X;
        /// <summary>Its first texel.</summary>
        public uint Y;
        /// <summary>Its first texel.</summary>
        public uint Z;
        /// <summary>Its size in texels.</summary>
        public uint Width;
        /// <summary>Its size in texels.</summary>
        public uint Height;
        /// <summary>Its size in texels.</summary>
        public uint Depth;
        /// <summary>0.</summary>
        public uint Reserved;
        /// <summary>x fastest, then y, then z, without gaps between rows.</summary>
        public IntPtr Texels;
        /// <summary>The size of `texels` in bytes.</summary>
        public UIntPtr ByteCount;
    }

    /// <summary>The settings of new textures.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct TexturesParams
    {
        public uint StructSize;
        public IntPtr Next;
        /// <summary>The noise that erodes the smoke; null: the defaults.</summary>
        public IntPtr Look;
        /// <summary>Time in which the noise rolls around once [s], [0.1, 1000].</summary>
        public float SwirlSeconds;
        /// <summary>Distance of the points at which the noise's displacement is known, 1 or 2 [voxels]. 2: a
        /// fifth of the uploads; the noise then differs from what brume_field_drawn_depths count, by about 1/100
        /// of the light.</summary>
        public uint NoiseSpacing;
        /// <summary>Number of lights whose way through smoke and walls is found on the CPU, [0,
        /// BRUME_MAX_TEXTURE_LIGHTS].</summary>
        public uint LightCount;
        /// <summary>1: the sky's light is found, too; 0: it is not.</summary>
        public uint Sky;
    }

    /// <summary>A light, as the texture of light needs it.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct TextureLight
    {
        /// <summary>1: a sun; 0: a light at a position.</summary>
        public uint Directional;
        /// <summary>The position [m], within +-16384; of a sun the unit vector towards it.</summary>
        public Point At;
    }

    /// <summary>A time at which the smoke is drawn.</summary>
    [StructLayout(LayoutKind.Sequential)]
    public struct TexturesFrame
    {
        public uint StructSize;
        public IntPtr Next;
        /// <summary>The clock of noise and holes [s], [0, 10^7]: the time of the field's state, or later, between
        /// ticks.</summary>
        public double Seconds;
        /// <summary>brume_textures_params::light_count of them.</summary>
        public IntPtr Lights;
        /// <summary>Fraction of the texels of light that this update finds, in turn, [1/16, 1]; 0: all. At a
        /// fraction f, light lags by up to 1/f updates, except where there was no smoke before.</summary>
        public float LightUpdateFraction;
    }

    /// <summary>The constants of the headers.</summary>
    public static class Limits
    {
        /// <summary>The version of this header. Before 1.0, a minor version may change the interface; the
        /// library's SOVERSION then changes too.</summary>
        public const uint VersionMajor = 0;
        public const uint VersionMinor = 2;
        public const uint VersionPatch = 0;
        /// <summary>The largest number of voxels of a level along one axis.</summary>
        public const uint MaxLevelAxis = 4096;
        /// <summary>The largest coordinate of a position and the largest length of an event [1/1024 m]: 16384
        /// m.</summary>
        public const uint MaxCoordinate = 16777216;
        /// <summary>The largest amount of one smoke [voxels].</summary>
        public const uint MaxSmokeVoxels = 134217728;
        /// <summary>The largest tick: 97 days at 64 ticks per second.</summary>
        public const uint MaxTick = 536870912;
        /// <summary>The largest number of events of one call.</summary>
        public const uint MaxEvents = 1048576;
        /// <summary>The largest number of elements in one array of queries.</summary>
        public const uint MaxQueries = 268435456;
        /// <summary>The number of constants that the shader reads: ten rows of four.</summary>
        public const uint Constants = 40;
        /// <summary>The largest number of holes that the shader cuts: the latest ones.</summary>
        public const uint MaxTextureHoles = 128;
        /// <summary>The largest number of lights of a texture of light.</summary>
        public const uint MaxTextureLights = 15;
    }

    /// <summary>The functions of the library, as the headers declare them.</summary>
    public static class Native
    {
        public const string Library = "brume-sim";

        /// <summary>Writes the version of the library in use. Any pointer may be null. Never fails.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_version(out uint major, out uint minor, out uint patch);

        /// <summary>Returns one line about the last failure in this thread: the function, the expected and the
        /// given value; "" before the first failure. UTF-8, at most 511 bytes. The pointer is valid until the
        /// next failure in this thread; calls that succeed do not change the line.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr brume_last_error();

        /// <summary>Returns the name of a result, such as "BRUME_OK"; "unknown" for a number that is not a
        /// brume_result. The string is a constant.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern IntPtr brume_result_name(Result result);

        /// <summary>Writes what brume_context_defaults returns into a struct of `struct_size` bytes: for other
        /// languages.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_context_params_init(out ContextParams @params, uint structSize);

        /// <summary>Creates a context, from which all other objects are created. `params` may be null: the
        /// defaults.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_context_create(ref ContextParams @params, out IntPtr context);

        /// <summary>Destroys a context; null is ignored. Objects of the context live on, without its callbacks:
        /// they are not called again, unless a call in another thread is already about to call them.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_context_destroy(IntPtr context);

        /// <summary>Writes what brume_voxels_defaults returns into a struct of `struct_size` bytes: for other
        /// languages.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_voxels_params_init(out VoxelsParams @params, uint structSize);

        /// <summary>Writes what brume_triangles_defaults returns into a struct of `struct_size` bytes: for other
        /// languages.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_triangles_params_init(out TrianglesParams @params, uint structSize);

        /// <summary>Creates a level from solid voxels. Smoke ends at their faces. Errors: BRUME_ERROR_LIMIT when
        /// an axis exceeds BRUME_MAX_LEVEL_AXIS.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_level_create_from_voxels(Context context, ref VoxelsParams @params,
            out IntPtr level);

        /// <summary>Creates a level from the triangles of its collision mesh. Every voxel that a wall or glass
        /// touches is solid, exactly (a triangle on a face between two voxels touches both), and smoke ends at
        /// the surface of the triangles, not at the grid. The same triangles, in the same order, with the same
        /// roles and layout give the same level on every machine. Errors: BRUME_ERROR_LIMIT when an axis would
        /// exceed BRUME_MAX_LEVEL_AXIS.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_level_create_from_triangles(Context context,
            ref TrianglesParams @params, out IntPtr level);

        /// <summary>Destroys a level; null is ignored. Its worlds and fields live on.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_level_destroy(IntPtr level);

        /// <summary>Writes the layout of the level.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_level_layout(Level level, out Layout layout);

        /// <summary>Writes the hash of the level as loaded, without the edits of any world: its layout, what each
        /// voxel stops, and the surfaces at which smoke ends. Levels of one hash give the same smoke and the same
        /// lines of sight on every machine. Give all machines the same triangles in the same order and winding.
        /// States and packets carry the hash, and calls that would combine two levels fail with
        /// BRUME_ERROR_MISMATCH. It is computed once, when a level is created: some 60 ns for each brick of 8^3
        /// voxels with a wall.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_level_hash(Level level, out ulong hash);

        /// <summary>Writes 1 for each voxel of the box [low, high) that is a wall or glass in the level as
        /// loaded, without the edits of any world, else 0; x fastest, then y, then z. The box must lie in the
        /// level and contain a voxel; `count` is the number of its voxels.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_level_solid(Level level, Voxel low, Voxel high, [Out] byte[] solid,
            UIntPtr count);

        /// <summary>Writes the brume_role of each voxel of the box [low, high), BRUME_ROLE_GHOST where a voxel is
        /// free. Order, box and `count` are as in brume_level_solid.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_level_roles(Level level, Voxel low, Voxel high, [Out] byte[] roles,
            UIntPtr count);

        /// <summary>Creates a set of masks; brume_shot_event::mask_index is an index into `images`, which are
        /// copied. At most 65,536 images. Sender and receiver need the same set. Errors: BRUME_ERROR_LIMIT when
        /// the images do not fit into 4096 x 4096 texels together.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_masks_create(Context context, [In] MaskImage[] images,
            UIntPtr count, out IntPtr masks);

        /// <summary>Destroys a set of masks; null is ignored. Worlds, fields and renderers that use it live
        /// on.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_masks_destroy(IntPtr masks);

        /// <summary>Rounds a point [m] to the nearest position. Errors: BRUME_ERROR_ARGUMENT when a coordinate is
        /// not finite or beyond +-16384 m.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_position_from_metres(double x, double y, double z,
            out Position position);

        /// <summary>Writes what brume_event_defaults returns: for other languages.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_event_init(out WorldEvent @event, uint kind, uint tick);

        /// <summary>Writes what brume_world_defaults returns into a struct of `struct_size` bytes: for other
        /// languages.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_world_params_init(out WorldParams @params, uint structSize);

        /// <summary>Creates a world at tick 0, without events. `params` may be null: the defaults.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_world_create(Level level, ref WorldParams @params,
            out IntPtr world);

        /// <summary>Destroys a world; null is ignored. Its states live on.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_world_destroy(IntPtr world);

        /// <summary>Adds events to the log, all or none, at most BRUME_MAX_EVENTS. Events at or before the
        /// present tick change the past: the world rolls back once and replays to the present, with the same
        /// result as if they had come in time. Events of one tick take effect in the order in which they were
        /// appended. Errors: BRUME_ERROR_HISTORY for an event before the last tick that was given to
        /// brume_world_forget_before, and for one at or before the tick of a restored state.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_world_append(World world, [In] WorldEvent[] events, UIntPtr count);

        /// <summary>Replaces all events at or after `tick` by others, each of that tick or later; a client
        /// corrects its prediction with it. Otherwise it works and fails as brume_world_append does.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_world_replace_from(World world, uint tick, [In] WorldEvent[] events,
            UIntPtr count);

        /// <summary>Moves the world to a tick in [0, BRUME_MAX_TICK], forwards or backwards. Only ticks at which
        /// an effect starts or ends cost time. Errors: BRUME_ERROR_HISTORY for a tick before
        /// brume_world_earliest_tick.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_world_advance_to(World world, uint tick);

        /// <summary>Moves the world to the next tick.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_world_step(World world);

        /// <summary>Writes the present tick.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_world_tick(World world, out uint tick);

        /// <summary>Writes the earliest tick to which the world can roll back.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_world_earliest_tick(World world, out uint tick);

        /// <summary>Drops the history before `tick`, and refuses late input exactly from there on: an event
        /// before `tick` is BRUME_ERROR_HISTORY, one of `tick` or later is accepted, also in a match in which
        /// nothing has happened. `tick` becomes the earliest tick; if it is after the present one, events before
        /// it are refused as well, and the present tick becomes the earliest. A lower tick than before changes
        /// nothing; brume_world_restore begins a new history without a limit. Call it every tick: without it,
        /// memory grows with the length of the match. The call is cheap.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_world_forget_before(World world, uint tick);

        /// <summary>Writes the hash of the present state, its level included. Equal states have equal hashes on
        /// every machine; at tick 0, equal hashes show that worlds have the same level, tick rate and
        /// masks.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_world_hash(World world, out ulong hash);

        /// <summary>Creates a snapshot of the present state. The call is cheap, because clouds are shared instead
        /// of copied.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_world_state(World world, out IntPtr state);

        /// <summary>Makes `state` the present state. Events up to its tick are dropped from the log, later ones
        /// remain; its tick becomes the earliest one. Errors: BRUME_ERROR_MISMATCH when the state comes from a
        /// world with another level, other ticks per second or other masks.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_world_restore(World world, State state);

        /// <summary>Destroys a state; null is ignored. Fields, senders and worlds that took it over have their
        /// own copy.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_state_destroy(IntPtr state);

        /// <summary>Writes counts and times.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_state_describe(State state, out StateInfo info);

        /// <summary>Writes the hash of the state, as brume_world_hash does.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_state_hash(State state, out ulong hash);

        /// <summary>Writes the state as bytes, a keyframe of the wire format; a grown cloud takes a few hundred
        /// bytes. Equal states give equal bytes. The first call encodes, further calls copy.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_state_save(State state, [Out] byte[] buffer, UIntPtr capacity,
            out UIntPtr size);

        /// <summary>brume_field_optical_depths of a line within a box gives what it does in the whole state, but
        /// for rounding (through holes of masks far from the origin up to 0.2 %) and, beside a thin wall, for
        /// smoke behind it in a closed space of fewer than 4096 voxels. A field of the filtered state has the
        /// client's results bit for bit. The noise of drawn smoke may lack the wake of a body or shot outside. Do
        /// not restore the state into a world that goes on. One box takes some 0.02 ms for 1,000 clouds; at most
        /// 4096 boxes; null if there are none. Errors: BRUME_ERROR_ARGUMENT for a box out of range.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_state_filter(State state, [In] Box[] boxes, UIntPtr boxCount,
            out IntPtr filtered);

        /// <summary>Creates a state from the bytes that brume_state_save wrote. At most 16 MiB and 2^26 voxels.
        /// The bytes need not be trusted. Errors: BRUME_ERROR_DATA when they are damaged or describe a state that
        /// no world can have.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_state_load(Context context, [In] byte[] bytes, UIntPtr size,
            out IntPtr state);

        /// <summary>Writes the grenades in the air, by rising id.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_state_grenades(State state, [Out] Grenade[] grenades,
            UIntPtr capacity, out UIntPtr count);

        /// <summary>Writes the clouds, by rising id.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_state_clouds(State state, [Out] Cloud[] clouds, UIntPtr capacity,
            out UIntPtr count);

        /// <summary>Writes the cavities of explosions, by rising id.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_state_blasts(State state, [Out] Blast[] blasts, UIntPtr capacity,
            out UIntPtr count);

        /// <summary>Writes the holes of shots, by rising id.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_state_holes(State state, [Out] Hole[] holes, UIntPtr capacity,
            out UIntPtr count);

        /// <summary>Writes the bodies, by rising number.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_state_bodies(State state, [Out] MovingBody[] bodies,
            UIntPtr capacity, out UIntPtr count);

        /// <summary>Writes what brume_sender_defaults returns into a struct of `struct_size` bytes: for other
        /// languages.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_sender_params_init(out SenderParams @params, uint structSize);

        /// <summary>Creates the sending side: one packet per tick for all receivers, and answers to those that
        /// missed some. `params` may be null: the defaults.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_sender_create(Context context, ref SenderParams @params,
            out IntPtr sender);

        /// <summary>Destroys a sender; null is ignored.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_sender_destroy(IntPtr sender);

        /// <summary>Takes the state of a tick and makes its packet: the difference from the last state, or the
        /// whole state on the first call. A state with fewer events than the last one starts a new world. Errors:
        /// BRUME_ERROR_ORDER unless its tick is above the last one's; BRUME_ERROR_MISMATCH when its world has
        /// another level, other ticks per second or other masks than the last one's.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_sender_push(Sender sender, State state);

        /// <summary>Writes the packet of the last state pushed, to be sent to every receiver. Errors:
        /// BRUME_ERROR_ORDER before the first push.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_sender_packet(Sender sender, [Out] byte[] buffer, UIntPtr capacity,
            out UIntPtr size);

        /// <summary>Writes the answer to a receiver's request, to be sent to that receiver: 0 bytes when it is up
        /// to date. The request need not be trusted. Errors: BRUME_ERROR_DATA when it is not a request;
        /// BRUME_ERROR_ORDER before the first push.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_sender_answer(Sender sender, [In] byte[] request,
            UIntPtr requestSize, [Out] byte[] buffer, UIntPtr capacity, out UIntPtr size);

        /// <summary>Writes what brume_receiver_defaults returns into a struct of `struct_size` bytes: for other
        /// languages.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_receiver_params_init(out ReceiverParams @params, uint structSize);

        /// <summary>Creates the receiving side, which requires no world. `params` may be null: the
        /// defaults.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_receiver_create(Context context, ref ReceiverParams @params,
            out IntPtr receiver);

        /// <summary>Destroys a receiver; null is ignored. Its states live on.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_receiver_destroy(IntPtr receiver);

        /// <summary>Processes a packet or an answer, in any order and with gaps, and held packets that build on
        /// it; writes the brume_reception of the given one; `reception` may be null. The packet need not be
        /// trusted. Errors: BRUME_ERROR_DATA when it is damaged or gives another state than the sender's; the
        /// receiver's state is then unchanged, and brume_receiver_behind writes 1. BRUME_ERROR_MISMATCH when the
        /// packet is a whole state of another level than the receiver's; the difference from such a state finds
        /// no state to build on.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_receiver_receive(Receiver receiver, [In] byte[] packet,
            UIntPtr size, out uint reception);

        /// <summary>Writes 1 when the receiver has detected that a state is missing, else 0. Send a request every
        /// few ticks until it is 0, and also when no packet has arrived for a while.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_receiver_behind(Receiver receiver, out uint behind);

        /// <summary>Writes a request for the sender, at most 16 bytes.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_receiver_request(Receiver receiver, [Out] byte[] buffer,
            UIntPtr capacity, out UIntPtr size);

        /// <summary>Creates a snapshot of the newest state, equal bit for bit to the sender's state of that tick.
        /// Errors: BRUME_ERROR_ORDER before the first state has been received.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_receiver_state(Receiver receiver, out IntPtr state);

        /// <summary>Drops all states, for a new match.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_receiver_reset(Receiver receiver);

        /// <summary>Writes what brume_field_defaults returns into a struct of `struct_size` bytes: for other
        /// languages.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_field_params_init(out FieldParams @params, uint structSize);

        /// <summary>Creates the density field of a level, without smoke. The field holds copies of all that its
        /// queries read: worlds may advance while other threads query it. `params` may be null: the
        /// defaults.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_field_create(Level level, ref FieldParams @params,
            out IntPtr field);

        /// <summary>Destroys a field; null is ignored.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_field_destroy(IntPtr field);

        /// <summary>Takes over a state with its smoke, holes and level edits. Only changes since the last update
        /// cost time. Errors: BRUME_ERROR_MISMATCH for a state of another level or with other masks;
        /// BRUME_ERROR_LIMIT when the smoke fills more than 2^22 bricks of 8^3 voxels.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_field_update(Field field, State state);

        /// <summary>Writes the bricks of 8^3 voxels (voxel / 8) in which the last update may have changed
        /// densities, by rising z, then y, then x. A copy of the densities has to read these bricks
        /// again.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_field_changed_bricks(Field field, [Out] Voxel[] bricks,
            UIntPtr capacity, out UIntPtr count);

        /// <summary>Writes the optical depth of the smoke along each segment, at most BRUME_MAX_QUERIES. Holes
        /// count, walls and the noise of the drawn smoke do not. exp(-depth) of the light passes. The results are
        /// the same bits on every machine, for any number of threads, for one segment or many.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_field_optical_depths(Field field, [In] Segment[] segments,
            UIntPtr count, [Out] float[] depths);

        /// <summary>Writes 1 for each segment whose ends are visible from each other, else 0. They are when no
        /// wall lies between the voxels of a and b (sight passes glass and grilles) and the optical depth is at
        /// most `threshold`. Walls are voxels here: the voxels of a and b themselves hide nothing, so that a
        /// point up to a voxel behind a wall may be visible, and a line along a wall or floor within a voxel of
        /// it is blocked. Use your own ray cast where that matters, and a threshold on brume_field_optical_depths
        /// for smoke. Optical depths of 1, 3 and 5 let 37, 5 and 0.7 % of the light pass. `threshold` is at least
        /// 0; infinity tests walls only. Guarantees are as for brume_field_optical_depths; this query is faster,
        /// as it ends at the first obstacle.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_field_visible(Field field, [In] Segment[] segments, UIntPtr count,
            float threshold, [Out] byte[] visible);

        /// <summary>Writes what brume_drawn_defaults returns into a struct of `struct_size` bytes: for other
        /// languages.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_drawn_params_init(out DrawnParams @params, uint structSize);

        /// <summary>Writes the optical depth along each segment as brume_field_optical_depths does, but of the
        /// smoke as a renderer draws it at the state's tick: eroded by noise, with frayed rims of holes. The
        /// results are the same bits on every machine. The query takes some hundred times as long; the first one
        /// in a process also generates the noise, in a second of CPU time, and the first one after an update, or
        /// with other `params`, takes some milliseconds more. `params` may be null: the defaults.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_field_drawn_depths(Field field, ref DrawnParams @params,
            [In] Segment[] segments, UIntPtr count, [Out] float[] depths);

        /// <summary>Writes visibility as brume_field_visible does, but through the smoke as a renderer draws it:
        /// it answers whether a player can see through the gaps of a rim. Cost and `params` are as for
        /// brume_field_drawn_depths.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_field_drawn_visible(Field field, ref DrawnParams @params,
            [In] Segment[] segments, UIntPtr count, float threshold, [Out] byte[] visible);

        /// <summary>Writes the first voxel of a wall along each segment, apart from the voxels that contain a and
        /// b.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_field_first_walls(Field field, [In] Segment[] segments,
            UIntPtr count, [Out] Wall[] walls);

        /// <summary>Writes the density of each voxel of the box [low, high), [0, 255], x fastest, then y, then z.
        /// Cavities of explosions count, holes and noise do not; solid voxels have 0. The box must lie in the
        /// level and contain a voxel; `count` is the number of its voxels.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_field_densities(Field field, Voxel low, Voxel high,
            [Out] byte[] densities, UIntPtr count);

        /// <summary>Writes what brume_textures_defaults returns into a struct of `struct_size` bytes: for other
        /// languages.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_textures_params_init(out TexturesParams @params, uint structSize);

        /// <summary>Writes what brume_textures_frame_defaults returns into a struct of `struct_size` bytes: for
        /// other languages.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_textures_frame_init(out TexturesFrame frame, uint structSize);

        /// <summary>Creates textures that follow a field, or other fields of its level and with its masks.
        /// `params` may be null: the defaults. The first one in a process generates the noise, in a second of CPU
        /// time.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_textures_create(Field field, ref TexturesParams @params,
            out IntPtr textures);

        /// <summary>Destroys textures; null is ignored.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_textures_destroy(IntPtr textures);

        /// <summary>Takes over a field's smoke at a time. What changed since the last update is then in
        /// brume_textures_regions. Any number of updates of the field may lie between two updates. Errors:
        /// BRUME_ERROR_MISMATCH for a field of another level or with other masks; BRUME_ERROR_LIMIT when the
        /// smoke has more than 65,534 bricks.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_textures_update(Textures textures, Field field,
            ref TexturesFrame frame);

        /// <summary>Writes the BRUME_TEXTURE_COUNT textures, by their kind. `list` has room for them, `capacity`
        /// of them.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_textures_list(Textures textures, [Out] SmokeTexture[] list,
            UIntPtr capacity);

        /// <summary>Writes where the regions that the last update changed begin, and how many they are. They and
        /// their texels are valid until the next update or the end of the textures.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_textures_regions(Textures textures, out IntPtr regions,
            out UIntPtr count);

        /// <summary>Writes the constants of the last update, brume_constants in the shader. `count` is
        /// BRUME_CONSTANTS.</summary>
        [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]
        public static extern Result brume_textures_constants(Textures textures, [Out] float[] constants,
            UIntPtr count);
    }
}
