using System;

namespace Brume
{
    /// <summary>The sending side: one packet per tick for all receivers, and answers to those that missed some. Bytes
    /// are written as lists of a State are.</summary>
    public sealed class Sender : Handle
    {
        private static readonly ListCall<Sender, byte> packet = Native.brume_sender_packet;

        public Sender(Context context) : this(context, Defaults.Sender())
        {
        }

        public Sender(Context context, SenderParams settings)
        {
            IntPtr created;
            Calls.Check(Native.brume_sender_create(context, ref settings, out created));
            SetHandle(created);
        }

        /// <summary>Takes the state of a tick and makes its packet.</summary>
        public void Push(State state)
        {
            Calls.Check(Native.brume_sender_push(this, state));
        }

        /// <summary>The packet of the last state pushed, for every receiver.</summary>
        public int Packet(ref byte[] bytes)
        {
            return Calls.Fill(packet, this, ref bytes);
        }

        /// <summary>The answer to a receiver's request, for that receiver; 0 bytes when it is up to date. The request
        /// need not be trusted.</summary>
        public int Answer(byte[] request, int requestSize, ref byte[] bytes)
        {
            UIntPtr asked = Calls.Count(request, requestSize, "request"), size;
            Calls.Check(Native.brume_sender_answer(this, request, asked, null, UIntPtr.Zero, out size));
            if (bytes == null || (ulong)bytes.Length < (ulong)size) bytes = new byte[(ulong)size];
            Calls.Check(Native.brume_sender_answer(this, request, asked, bytes, (UIntPtr)(uint)bytes.Length, out size));
            return (int)(uint)size;
        }

        protected override bool ReleaseHandle()
        {
            return Native.brume_sender_destroy(handle) == Result.Ok;
        }
    }

    /// <summary>The receiving side, which requires no world.</summary>
    public sealed class Receiver : Handle
    {
        private static readonly ListCall<Receiver, byte> request = Native.brume_receiver_request;

        public Receiver(Context context) : this(context, Defaults.Receiver())
        {
        }

        /// <param name="level">The level that the sender's states must be of; null: any.</param>
        public Receiver(Context context, ReceiverParams settings, Level level = null)
        {
            using (Borrowed borrowed = new Borrowed(level))
            {
                settings.Level = borrowed.Pointer;
                IntPtr created;
                Calls.Check(Native.brume_receiver_create(context, ref settings, out created));
                SetHandle(created);
            }
        }

        /// <summary>Processes a packet or an answer, in any order and with gaps. It need not be trusted.</summary>
        public Reception Receive(byte[] bytes, int size)
        {
            uint reception;
            Calls.Check(Native.brume_receiver_receive(this, bytes, Calls.Count(bytes, size, "bytes"), out reception));
            return (Reception)reception;
        }

        /// <summary>Whether a state is missing: send a request every few ticks until it is false, and also when no
        /// packet has arrived for a while.</summary>
        public bool Behind
        {
            get
            {
                uint behind;
                Calls.Check(Native.brume_receiver_behind(this, out behind));
                return behind != 0;
            }
        }

        public int Request(ref byte[] bytes)
        {
            return Calls.Fill(request, this, ref bytes);
        }

        /// <summary>A snapshot of the newest state, equal bit for bit to the sender's, to be disposed.</summary>
        public State Snapshot()
        {
            IntPtr state;
            Calls.Check(Native.brume_receiver_state(this, out state));
            return new State(state);
        }

        /// <summary>Drops all states, for a new match.</summary>
        public void Reset()
        {
            Calls.Check(Native.brume_receiver_reset(this));
        }

        protected override bool ReleaseHandle()
        {
            return Native.brume_receiver_destroy(handle) == Result.Ok;
        }
    }
}
