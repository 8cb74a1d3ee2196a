using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Text;

namespace Brume
{
    /// <summary>A call failed. The message is the library's line: function, expected and given value.</summary>
    public sealed class BrumeException : Exception
    {
        public Result Result { get; private set; }

        public BrumeException(Result result, string line) : base(line)
        {
            Result = result;
        }
    }

    /// <summary>An object of the library. Dispose or the garbage collector releases it, once no call that was
    /// given it is running any more.</summary>
    public abstract class Handle : SafeHandle
    {
        protected Handle() : base(IntPtr.Zero, true)
        {
        }

        public override bool IsInvalid
        {
            get { return handle == IntPtr.Zero; }
        }
    }

    internal delegate Result ListCall<THandle, T>(THandle handle, T[] items, UIntPtr capacity, out UIntPtr count);

    internal static class Calls
    {
        internal static void Check(Result result)
        {
            if (result != Result.Ok) throw new BrumeException(result, Utf8(Native.brume_last_error()));
        }

        /// <summary>Copies a string that the library owns.</summary>
        internal static string Utf8(IntPtr text)
        {
            int length = 0;
            while (Marshal.ReadByte(text, length) != 0) ++length;
            byte[] bytes = new byte[length];
            Marshal.Copy(text, bytes, 0, length);
            return Encoding.UTF8.GetString(bytes);
        }

        /// <summary>Fills an array from its start, a longer one where it is too short, and returns how many elements
        /// the library wrote.</summary>
        internal static int Fill<THandle, T>(ListCall<THandle, T> call, THandle handle, ref T[] items)
        {
            UIntPtr count;
            Check(call(handle, null, UIntPtr.Zero, out count));
            if (items == null || (ulong)items.Length < (ulong)count) items = new T[(ulong)count];
            Check(call(handle, items, (UIntPtr)items.Length, out count));
            return (int)(uint)count;
        }

        /// <summary>The library writes or reads `count` elements: fewer would be an access out of bounds.</summary>
        internal static UIntPtr Count<T>(T[] items, int count, string name)
        {
            if (count < 0) throw new ArgumentOutOfRangeException("count", "at least 0 is expected, not " + count);
            int length = items == null ? 0 : items.Length;
            if (length < count)
                throw new ArgumentException(count + " elements are expected, not " + length, name);
            return (UIntPtr)(uint)count;
        }

        /// <summary>The number of voxels of a box, which the output has to hold.</summary>
        internal static UIntPtr Volume(Voxel low, Voxel high, byte[] output, string name)
        {
            long x = (long)high.X - low.X, y = (long)high.Y - low.Y, z = (long)high.Z - low.Z;
            // The library refuses other boxes, and names what is wrong with them.
            if (x <= 0 || y <= 0 || z <= 0 || x > Limits.MaxLevelAxis || y > Limits.MaxLevelAxis ||
                z > Limits.MaxLevelAxis)
                return UIntPtr.Zero;
            if (output == null || output.Length < x * y * z)
                throw new ArgumentException(x * y * z + " bytes are expected, not " +
                                            (output == null ? 0 : output.Length), name);
            return (UIntPtr)(ulong)(x * y * z);
        }
    }

    /// <summary>The pointer of an object for a struct, which keeps the object until this is disposed.</summary>
    internal sealed class Borrowed : IDisposable
    {
        private readonly Handle owner;
        private readonly bool held;

        /// <param name="owner">Null: a null pointer.</param>
        internal Borrowed(Handle owner)
        {
            this.owner = owner;
            if (owner != null) owner.DangerousAddRef(ref held);
        }

        internal IntPtr Pointer
        {
            get { return owner == null ? IntPtr.Zero : owner.DangerousGetHandle(); }
        }

        public void Dispose()
        {
            if (held) owner.DangerousRelease();
        }
    }

    /// <summary>Arrays that stay where they are until this is disposed: for pointers within structs.</summary>
    internal sealed class Pins : IDisposable
    {
        private readonly List<GCHandle> pins = new List<GCHandle>();

        internal IntPtr Add(Array array)
        {
            if (array == null) return IntPtr.Zero;
            GCHandle pin = GCHandle.Alloc(array, GCHandleType.Pinned);
            pins.Add(pin);
            return pin.AddrOfPinnedObject();
        }

        public void Dispose()
        {
            foreach (GCHandle pin in pins) pin.Free();
            pins.Clear();
        }
    }
}
