/* The robot's serial link for firmware in C: frames and messages, protocol 2.0.
 *
 * Plain C99 in this one file. It allocates no memory and needs only <stdint.h>, <stdbool.h>,
 * <stddef.h> and <string.h>. It implements docs/reference/robot-protocol.md and is tested against the same
 * golden frames as the Rust crate coinmc-link.
 *
 * Licensed under MIT or Apache-2.0, at your option. */
#ifndef COINMC_LINK_H
#define COINMC_LINK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define COINMC_MAJOR 2
#define COINMC_MINOR 0

/* ---- frames: 0x00 | COBS( session u16 | seq u16 | body | CRC-32 ) | 0x00, little-endian ---- */

#define COINMC_MAX_PLAIN 64
#define COINMC_MAX_BODY (COINMC_MAX_PLAIN - 8)
#define COINMC_MAX_WIRE (COINMC_MAX_PLAIN + 3)

/* CRC-32/ISO-HDLC, as in zlib; begin with crc = 0. */
static inline uint32_t coinmc_crc32(uint32_t crc, const uint8_t *bytes, size_t length)
{
    crc = ~crc;
    for (size_t i = 0; i < length; i++) {
        crc ^= bytes[i];
        for (uint8_t bit = 0; bit < 8; bit++)
            crc = (crc >> 1) ^ (UINT32_C(0xEDB88320) & (uint32_t)-(int32_t)(crc & 1));
    }
    return ~crc;
}

/* Encodes the frame of a message. Returns its length, or 0 if the body is too long. */
static inline uint8_t coinmc_frame(uint16_t session, uint16_t seq, const uint8_t *body,
                                   uint8_t length, uint8_t wire[COINMC_MAX_WIRE])
{
    if (length > COINMC_MAX_BODY)
        return 0;
    uint8_t plain[COINMC_MAX_PLAIN], size = 0;
    plain[size++] = (uint8_t)session;
    plain[size++] = (uint8_t)(session >> 8);
    plain[size++] = (uint8_t)seq;
    plain[size++] = (uint8_t)(seq >> 8);
    memcpy(plain + size, body, length);
    size = (uint8_t)(size + length);
    uint32_t crc = coinmc_crc32(0, plain, size);
    for (uint8_t i = 0; i < 4; i++, crc >>= 8)
        plain[size++] = (uint8_t)crc;
    uint8_t at = 0, code;
    wire[at++] = 0;
    code = at++;
    for (uint8_t i = 0; i < size; i++) {
        if (plain[i] == 0) { /* ends the block: its length plus one goes before it */
            wire[code] = (uint8_t)(at - code);
            code = at++;
        } else {
            wire[at++] = plain[i];
        }
    }
    wire[code] = (uint8_t)(at - code);
    wire[at++] = 0;
    return at;
}

/* Decodes frames from bytes as they arrive. Initialise it to zero. */
typedef struct {
    uint8_t plain[COINMC_MAX_PLAIN];
    uint8_t length, left, position;
} coinmc_decoder;

typedef enum { COINMC_NOTHING, COINMC_FRAME, COINMC_REJECT } coinmc_pushed;

typedef struct {
    uint16_t session, seq;
    const uint8_t *body; /* valid until the next byte is pushed */
    uint8_t length;
} coinmc_received;

enum { COINMC_START, COINMC_INSIDE, COINMC_OVERLONG };

static inline void coinmc_keep(coinmc_decoder *decoder, uint8_t byte)
{
    if (decoder->length < COINMC_MAX_PLAIN)
        decoder->plain[decoder->length++] = byte;
    else
        decoder->position = COINMC_OVERLONG;
}

/* Takes one byte. COINMC_FRAME fills in `frame`; COINMC_REJECT reports a damaged frame. */
static inline coinmc_pushed coinmc_push(coinmc_decoder *decoder, uint8_t byte,
                                        coinmc_received *frame)
{
    if (byte != 0) {
        if (decoder->position == COINMC_START) {
            decoder->position = COINMC_INSIDE;
            decoder->length = 0;
            decoder->left = (uint8_t)(byte - 1);
        } else if (decoder->position == COINMC_INSIDE) {
            bool code = decoder->left == 0;
            coinmc_keep(decoder, code ? 0 : byte);
            decoder->left = (uint8_t)(code ? byte - 1 : decoder->left - 1);
        }
        return COINMC_NOTHING;
    }
    uint8_t position = decoder->position, left = decoder->left, length = decoder->length;
    decoder->position = COINMC_START;
    decoder->left = 0;
    if (position == COINMC_START)
        return COINMC_NOTHING;
    if (position == COINMC_OVERLONG || left > 0 || length < 8)
        return COINMC_REJECT;
    const uint8_t *plain = decoder->plain, *end = plain + length - 4;
    uint32_t crc = end[0] | (uint32_t)end[1] << 8 | (uint32_t)end[2] << 16 | (uint32_t)end[3] << 24;
    if (crc != coinmc_crc32(0, plain, (size_t)length - 4))
        return COINMC_REJECT;
    frame->session = (uint16_t)(plain[0] | plain[1] << 8);
    frame->seq = (uint16_t)(plain[2] | plain[3] << 8);
    frame->body = plain + 4;
    frame->length = (uint8_t)(length - 8);
    return COINMC_FRAME;
}

/* ---- messages: the number of the variant, then the fields in order ---- */

typedef enum {
    COINMC_REQUEST_HELLO,
    COINMC_REQUEST_INFO,
    COINMC_REQUEST_STATUS,
    COINMC_REQUEST_STOP,
    COINMC_REQUEST_HOME,
    COINMC_REQUEST_THROW,
    COINMC_REQUEST_MOVE_CARRIAGE,
    COINMC_REQUEST_LIGHT,
    COINMC_REQUEST_COLLECT,
    COINMC_REQUEST_CLEAR_FAULT,
    COINMC_REQUEST_SET_COUNTER
} coinmc_request_kind;

typedef enum {
    COINMC_REPLY_HELLO,
    COINMC_REPLY_INFO,
    COINMC_REPLY_OK,
    COINMC_REPLY_NAK,
    COINMC_REPLY_STATUS
} coinmc_reply_kind;

typedef enum {
    COINMC_NAK_BAD_MESSAGE,
    COINMC_NAK_BAD_RANGE,
    COINMC_NAK_WRONG_STATE,
    COINMC_NAK_WRONG_ID,
    COINMC_NAK_NO_SESSION,
    COINMC_NAK_BUSY
} coinmc_nak;

typedef enum {
    COINMC_BOOT,
    COINMC_IDLE,
    COINMC_AIMING,
    COINMC_FLYING,
    COINMC_DRIVING,
    COINMC_AT_COIN,
    COINMC_RETURNING,
    COINMC_FAULT
} coinmc_state;

/* Bits of Home's axes. */
enum { COINMC_AXIS_X = 1, COINMC_AXIS_Y = 2, COINMC_AXIS_LIFT = 4, COINMC_AXIS_SPINDLE = 8 };
/* Bits of Info's capabilities. */
enum { COINMC_HAS_LIGHT = 1, COINMC_HAS_CARRIAGE = 2 };
/* Fault codes; the number of the phase, state or failure is added to the last three. */
enum {
    COINMC_FAULT_STOPPED = 1,
    COINMC_FAULT_SILENCE = 2,
    COINMC_FAULT_JOURNAL = 3,
    COINMC_FAULT_EMERGENCY = 4,
    COINMC_FAULT_RESET = 100,
    COINMC_FAULT_LIMIT = 200,
    COINMC_FAULT_HARDWARE = 300
};

typedef struct {
    uint8_t kind;          /* coinmc_request_kind; determines which fields are used */
    uint8_t major, minor;  /* Hello */
    uint16_t session;      /* Hello */
    uint8_t axes;          /* Home */
    uint32_t throw_id;     /* Throw, Collect, SetCounter */
    uint32_t experiment;   /* Throw, SetCounter; 0 for none */
    uint16_t spin_mrev_s;  /* Throw: 0 to 5000 */
    uint16_t angle_cdeg;   /* Throw: 0 to 18000 */
    int32_t x_um, y_um;    /* MoveCarriage: within 2 m of home */
    uint16_t permille;     /* Light: 0 to 1000 */
    uint16_t code;         /* ClearFault */
} coinmc_request;

typedef struct {
    uint8_t major, minor;
    uint16_t boot;
    uint32_t throw_id;
    uint8_t state;
} coinmc_greeting;

typedef struct {
    uint8_t uid[8], firmware[3];
    uint32_t capabilities;
    uint16_t spin_mrev_s, angle_cdeg; /* limits */
    int32_t x_um, y_um;
} coinmc_info;

typedef struct {
    uint8_t state;
    uint32_t throw_id, experiment;
    uint16_t spin_mrev_s, angle_cdeg; /* asked for; 0 after a start */
    bool released;
    uint16_t meas_spin_mrev_s, meas_angle_cdeg;
    int32_t x_um, y_um;
    uint32_t t_ms, t_release_ms;
    uint16_t fault, rx_bad;
} coinmc_status;

typedef struct {
    uint8_t kind; /* coinmc_reply_kind; determines which member is used */
    union {
        coinmc_greeting hello;
        coinmc_info info;
        struct {
            uint32_t throw_id;
            uint8_t state;
        } ok;
        uint8_t nak;
        coinmc_status status;
    } as;
} coinmc_reply;

/* A body being written; `good` becomes false, permanently, when it does not fit. */
typedef struct {
    uint8_t *bytes;
    uint8_t at;
    bool good;
} coinmc_writer;

/* A body being read; `good` becomes false, permanently, when it is malformed. */
typedef struct {
    const uint8_t *bytes;
    uint8_t length, at;
    bool good;
} coinmc_reader;

static inline void coinmc_put_u8(coinmc_writer *body, uint8_t value)
{
    if (body->at < COINMC_MAX_BODY)
        body->bytes[body->at++] = value;
    else
        body->good = false;
}

/* Seven bits per byte, lowest first; the eighth bit is set if more bytes follow. */
static inline void coinmc_put_u32(coinmc_writer *body, uint32_t value)
{
    for (; value > 0x7F; value >>= 7)
        coinmc_put_u8(body, (uint8_t)(value | 0x80));
    coinmc_put_u8(body, (uint8_t)value);
}

/* Zigzag: 0, -1, 1, -2 become 0, 1, 2, 3. */
static inline void coinmc_put_i32(coinmc_writer *body, int32_t value)
{
    uint32_t twice = (uint32_t)value << 1;
    coinmc_put_u32(body, value < 0 ? ~twice : twice);
}

static inline uint8_t coinmc_get_u8(coinmc_reader *body)
{
    if (body->at < body->length)
        return body->bytes[body->at++];
    body->good = false;
    return 0;
}

/* Accepts only the shortest encoding, and only values up to `greatest`. */
static inline uint32_t coinmc_get_uint(coinmc_reader *body, uint32_t greatest)
{
    uint32_t value = 0;
    uint8_t shift = 0, byte;
    do {
        byte = coinmc_get_u8(body);
        if (shift == 28 && byte > 0x0F)
            body->good = false;
        value |= (uint32_t)(byte & 0x7F) << shift;
        shift = (uint8_t)(shift + 7);
    } while (body->good && (byte & 0x80) != 0);
    if ((shift > 7 && byte == 0) || value > greatest)
        body->good = false;
    return value;
}

static inline uint16_t coinmc_get_u16(coinmc_reader *body)
{
    return (uint16_t)coinmc_get_uint(body, UINT16_MAX);
}

static inline uint32_t coinmc_get_u32(coinmc_reader *body)
{
    return coinmc_get_uint(body, UINT32_MAX);
}

static inline int32_t coinmc_get_i32(coinmc_reader *body)
{
    uint32_t zigzag = coinmc_get_u32(body);
    return (int32_t)(zigzag >> 1) ^ -(int32_t)(zigzag & 1);
}

/* Whether all numbers of a request are within the protocol's ranges. */
static inline bool coinmc_request_in_range(const coinmc_request *request)
{
    const int32_t reach_um = 2000000;
    switch (request->kind) {
    case COINMC_REQUEST_HELLO:
        return request->session != 0;
    case COINMC_REQUEST_HOME:
        return request->axes != 0 && request->axes <= 15;
    case COINMC_REQUEST_THROW:
        return request->throw_id != 0 && request->spin_mrev_s <= 5000 &&
               request->angle_cdeg <= 18000;
    case COINMC_REQUEST_MOVE_CARRIAGE:
        return request->x_um >= -reach_um && request->x_um <= reach_um &&
               request->y_um >= -reach_um && request->y_um <= reach_um;
    case COINMC_REQUEST_LIGHT:
        return request->permille <= 1000;
    default:
        return true;
    }
}

typedef enum { COINMC_GOOD, COINMC_MALFORMED, COINMC_OUT_OF_RANGE } coinmc_read;

/* Decodes the body of a request. */
static inline coinmc_read coinmc_read_request(const uint8_t *bytes, uint8_t length,
                                              coinmc_request *request)
{
    coinmc_reader body = {bytes, length, 0, true};
    memset(request, 0, sizeof *request);
    request->kind = coinmc_get_u8(&body);
    switch (request->kind) {
    case COINMC_REQUEST_HELLO:
        request->major = coinmc_get_u8(&body);
        request->minor = coinmc_get_u8(&body);
        request->session = coinmc_get_u16(&body);
        break;
    case COINMC_REQUEST_HOME:
        request->axes = coinmc_get_u8(&body);
        break;
    case COINMC_REQUEST_THROW:
        request->throw_id = coinmc_get_u32(&body);
        request->experiment = coinmc_get_u32(&body);
        request->spin_mrev_s = coinmc_get_u16(&body);
        request->angle_cdeg = coinmc_get_u16(&body);
        break;
    case COINMC_REQUEST_MOVE_CARRIAGE:
        request->x_um = coinmc_get_i32(&body);
        request->y_um = coinmc_get_i32(&body);
        break;
    case COINMC_REQUEST_LIGHT:
        request->permille = coinmc_get_u16(&body);
        break;
    case COINMC_REQUEST_COLLECT:
        request->throw_id = coinmc_get_u32(&body);
        break;
    case COINMC_REQUEST_SET_COUNTER:
        request->throw_id = coinmc_get_u32(&body);
        request->experiment = coinmc_get_u32(&body);
        break;
    case COINMC_REQUEST_CLEAR_FAULT:
        request->code = coinmc_get_u16(&body);
        break;
    case COINMC_REQUEST_INFO:
    case COINMC_REQUEST_STATUS:
    case COINMC_REQUEST_STOP:
        break;
    default:
        return COINMC_MALFORMED;
    }
    if (!body.good || body.at != body.length)
        return COINMC_MALFORMED;
    return coinmc_request_in_range(request) ? COINMC_GOOD : COINMC_OUT_OF_RANGE;
}

/* Encodes the body of a reply. Returns its length; every reply fits. */
static inline uint8_t coinmc_write_reply(const coinmc_reply *reply, uint8_t bytes[COINMC_MAX_BODY])
{
    coinmc_writer body = {bytes, 0, true};
    coinmc_put_u8(&body, reply->kind);
    switch (reply->kind) {
    case COINMC_REPLY_HELLO:
        coinmc_put_u8(&body, reply->as.hello.major);
        coinmc_put_u8(&body, reply->as.hello.minor);
        coinmc_put_u32(&body, reply->as.hello.boot);
        coinmc_put_u32(&body, reply->as.hello.throw_id);
        coinmc_put_u8(&body, reply->as.hello.state);
        break;
    case COINMC_REPLY_INFO:
        for (uint8_t i = 0; i < 8; i++)
            coinmc_put_u8(&body, reply->as.info.uid[i]);
        for (uint8_t i = 0; i < 3; i++)
            coinmc_put_u8(&body, reply->as.info.firmware[i]);
        coinmc_put_u32(&body, reply->as.info.capabilities);
        coinmc_put_u32(&body, reply->as.info.spin_mrev_s);
        coinmc_put_u32(&body, reply->as.info.angle_cdeg);
        coinmc_put_i32(&body, reply->as.info.x_um);
        coinmc_put_i32(&body, reply->as.info.y_um);
        break;
    case COINMC_REPLY_OK:
        coinmc_put_u32(&body, reply->as.ok.throw_id);
        coinmc_put_u8(&body, reply->as.ok.state);
        break;
    case COINMC_REPLY_NAK:
        coinmc_put_u8(&body, reply->as.nak);
        break;
    default:
        coinmc_put_u8(&body, reply->as.status.state);
        coinmc_put_u32(&body, reply->as.status.throw_id);
        coinmc_put_u32(&body, reply->as.status.experiment);
        coinmc_put_u32(&body, reply->as.status.spin_mrev_s);
        coinmc_put_u32(&body, reply->as.status.angle_cdeg);
        coinmc_put_u8(&body, reply->as.status.released);
        coinmc_put_u32(&body, reply->as.status.meas_spin_mrev_s);
        coinmc_put_u32(&body, reply->as.status.meas_angle_cdeg);
        coinmc_put_i32(&body, reply->as.status.x_um);
        coinmc_put_i32(&body, reply->as.status.y_um);
        coinmc_put_u32(&body, reply->as.status.t_ms);
        coinmc_put_u32(&body, reply->as.status.t_release_ms);
        coinmc_put_u32(&body, reply->as.status.fault);
        coinmc_put_u32(&body, reply->as.status.rx_bad);
        break;
    }
    return body.good ? body.at : 0;
}

#endif
