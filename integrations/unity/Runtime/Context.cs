using System;
using System.Collections.Generic;

namespace Brume
{
    /// <summary>Receives the line of each failed call, in its thread, and warnings with Result.Ok.</summary>
    public delegate void Log(Result result, string line);

    /// <summary>What all other objects are created from.</summary>
    public sealed class Context : Handle
    {
        // The library calls one static function, as code that is compiled ahead of time requires. `user` is a number
        // and not an object: a call that begins while its context is released finds no log here, and does nothing.
        private static readonly LogCallback callback = OnLine;
        private static readonly Dictionary<long, Log> logs = new Dictionary<long, Log>();
        private static long nextLog;

        private readonly long number;

        /// <param name="threadCount">Threads of one call, the caller's included; 0: one per core.</param>
        /// <param name="log">Null: none. What it throws is ignored.</param>
        public Context(uint threadCount = 0, Log log = null)
        {
            ContextParams settings = Defaults.Context();
            settings.ThreadCount = threadCount;
            if (log != null)
            {
                lock (logs)
                {
                    number = ++nextLog;
                    logs.Add(number, log);
                }
                settings.Log = System.Runtime.InteropServices.Marshal.GetFunctionPointerForDelegate(callback);
                settings.LogUser = new IntPtr(number);
            }
            IntPtr created;
            Result result = Native.brume_context_create(ref settings, out created);
            if (result != Result.Ok) Forget();
            Calls.Check(result);
            SetHandle(created);
        }

        /// <summary>The version of the library in use; Limits has that of these scripts.</summary>
        public static Version LibraryVersion
        {
            get
            {
                uint major, minor, patch;
                Calls.Check(Native.brume_version(out major, out minor, out patch));
                return new Version((int)major, (int)minor, (int)patch);
            }
        }

        protected override bool ReleaseHandle()
        {
            bool released = Native.brume_context_destroy(handle) == Result.Ok;
            Forget();
            return released;
        }

        private void Forget()
        {
            lock (logs) logs.Remove(number);
        }

        [MonoPInvokeCallback(typeof(LogCallback))]
        private static void OnLine(IntPtr user, Result result, IntPtr line)
        {
            Log log;
            lock (logs)
            {
                if (!logs.TryGetValue(user.ToInt64(), out log)) return;
            }
            try
            {
                log(result, Calls.Utf8(line));
            }
            catch (Exception)
            {
                // An exception must not pass through the library's frames.
            }
        }
    }

    /// <summary>IL2CPP looks for this name at functions that native code calls.</summary>
    [AttributeUsage(AttributeTargets.Method)]
    internal sealed class MonoPInvokeCallbackAttribute : Attribute
    {
        public MonoPInvokeCallbackAttribute(Type type)
        {
        }
    }
}
